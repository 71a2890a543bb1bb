#include "meshes/obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "meshes/faces.h"
#include "meshes/mtl.h"
#include "meshes/notes.h"
#include "meshes/number.h"
#include "meshes/obj_library.h"
#include "meshes/text_lines.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::meshes {

using trace::in_quotes;

namespace {

constexpr std::uint32_t none = ~0u;
constexpr std::size_t most_corner_bytes = 100, most_libraries = 1000;

// Of free-form curves and surfaces, appendix B1.
constexpr std::array<std::string_view, 19> free_form{
    "vp",   "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim",
    "hole", "scrv",   "sp",  "end",  "con",  "bzp",  "bsp",   "cdc",  "cdp"};

class ObjReader {
public:
    explicit ObjReader(const Source& source) : source_(source), line_(source.bytes, source.file) {}

    Mesh read() {
        while (line_.next()) read_line(line_.keyword());
        check_forward_references();
        make_surface();
        make_materials();
        mesh_.notes = notes_.lines();
        return std::move(mesh_);
    }

private:
    enum Part { vertex, texture, normal };
    static constexpr std::array<std::string_view, 3> part_names{"vertex", "texture coordinate", "normal"};

    struct Corner {
        std::uint32_t vertex, normal;  // normal: none, or from 0.
    };
    /// Of a positive index the greatest, which may name what comes later in the file.
    struct Reference {
        std::uint64_t index = 0, line = 0;
    };

    void read_line(std::string_view keyword) {
        if (keyword == "v") {
            read_vertex();
        } else if (keyword == "f" || keyword == "fo") {
            read_face();
        } else if (keyword == "vn") {
            const Vec3 n = triple("a normal");
            const Vec3 unit = trace::normalize(n);
            normals_.push_back(trace::is_finite(unit) ? unit : Vec3{});
            if (!line_.rest().empty())
                notes_.add("words behind the three numbers of a normal (vn) are not read");
        } else if (keyword == "vt") {
            ++counts_[texture];
        } else if (keyword == "usemtl") {
            use_material(unquoted(line_.rest()));
        } else if (keyword == "mtllib") {
            read_library_names();
        } else if (keyword == "g" || keyword == "o") {
            group_ = entry_of(group_names_, mesh_.groups, line_.rest());
        } else if (keyword == "s") {
            if (line_.rest() != "off" && line_.rest() != "0" && !line_.rest().empty()) ++smoothing_lines_;
        } else if (keyword == "l" || keyword == "p") {
            notes_.add(keyword == "l" ? "lines (l) are not read" : "points (p) are not read");
        } else if (std::find(free_form.begin(), free_form.end(), keyword) != free_form.end()) {
            notes_.add("lines of free-form curves and surfaces (curv, surf and the like) are not read");
        } else {
            notes_.add(fmt::format("lines that open with {} are not read", in_quotes(keyword)));
        }
    }

    // The number of `name` in `list`, where it is put when it is new.
    static std::uint32_t entry_of(std::map<std::string, std::uint32_t, std::less<>>& numbers,
                                  std::vector<std::string>& list, std::string_view name) {
        const auto found = numbers.find(name);
        if (found != numbers.end()) return found->second;
        list.emplace_back(name);
        return numbers.emplace(name, static_cast<std::uint32_t>(list.size() - 1)).first->second;
    }

    static std::string_view unquoted(std::string_view name) {
        return name.size() > 1 && name.front() == '"' && name.back() == '"' ? name.substr(1, name.size() - 2)
                                                                            : name;
    }

    void use_material(std::string_view name) {
        material_ = name.empty() ? none : entry_of(material_names_, used_materials_, name);
        if (name.empty()) notes_.add("usemtl without a name: the faces behind it have \"default\", a grey");
    }

    void read_library_names() {
        if (line_.rest().empty()) notes_.add("mtllib without a name is passed over");
        for (std::string& name : library_names(line_.rest(), source_))
            if (std::find(libraries_.begin(), libraries_.end(), name) == libraries_.end())
                libraries_.push_back(std::move(name));
        if (libraries_.size() > most_libraries)
            line_.fail(fmt::format("more than {} material libraries", most_libraries), "at most as many");
    }

    float number(std::string_view what) {
        const std::string_view word = line_.word();
        const std::optional<float> value = finite_float(word);
        if (!value)
            line_.fail(word.empty() ? fmt::format("{} without its numbers", what) : in_quotes(word),
                       "a finite number");
        return *value;
    }

    Vec3 triple(std::string_view what) {
        Vec3 v;
        for (int axis = 0; axis < 3; ++axis) v[axis] = number(what);
        return v;
    }

    // x y z, perhaps a weight, perhaps a colour of three.
    void read_vertex() {
        if (counts_[vertex] == most_vertices)
            line_.fail(fmt::format("more than {} vertices", most_vertices), "no more");
        vertices_.push_back(triple("a vertex"));
        ++counts_[vertex];
        std::array<float, 4> more{};
        std::size_t count = 0;
        for (; count < more.size() && !line_.rest().empty(); ++count) more[count] = number("a vertex");
        if (count == 2 || !line_.rest().empty())
            line_.fail(fmt::format("a vertex of {} numbers", count == 2 ? "5" : "more than 7"),
                       "3, 4, 6 or 7");
        if (count >= 3) notes_.add("colours of vertices are not read");
        if (count == 1 && more[0] != 1)
            notes_.add("weights of vertices (a fourth number other than 1) are not used");
    }

    void read_face() {
        for (std::string_view word = line_.word(); !word.empty(); word = line_.word())
            corners_.push_back(corner(word));
        if (corners_.size() > 3 * most_triangles)
            line_.fail(fmt::format("more than {} corners of faces", 3 * most_triangles), "at most as many");
        ends_.push_back(static_cast<std::uint32_t>(corners_.size()));
        face_line_.push_back(static_cast<std::uint32_t>(line_.number()));
        face_material_.push_back(material_);
        face_group_.push_back(group_);
    }

    // v, v/t, v//n or v/t/n.
    Corner corner(std::string_view word) {
        std::array<std::uint32_t, 3> index{none, none, none};
        std::string_view left = word.substr(0, most_corner_bytes);
        std::size_t part = 0;
        for (bool more = true; more; ++part) {
            const std::size_t slash = left.find('/');
            const std::string_view digits = left.substr(0, slash);
            more = slash != left.npos;
            if (part > 2) line_.fail("the corner " + in_quotes(word), "v, v/t, v//n or v/t/n");
            if (!digits.empty() || part == vertex)
                index[part] = resolved(static_cast<Part>(part), digits, word);
            left.remove_prefix(more ? slash + 1 : left.size());
        }
        return {index[vertex], index[normal]};
    }

    std::uint64_t count_of(Part part) const { return part == normal ? normals_.size() : counts_[part]; }

    std::uint32_t resolved(Part part, std::string_view digits, std::string_view word) {
        const std::optional<std::int64_t> index = whole_number(digits);
        const auto so_far = static_cast<std::int64_t>(count_of(part));
        if (!index) line_.fail("the corner " + in_quotes(word), "whole numbers: v, v/t, v//n or v/t/n");
        if (*index < 0) {
            if (*index < -so_far)
                line_.fail(
                    fmt::format("the {} {} in the corner {}", part_names[part], *index, in_quotes(word)),
                    so_far > 0 ? fmt::format("{} to -1, counted back from here", -so_far)
                               : fmt::format("a {} before it", part_names[part]));
            return static_cast<std::uint32_t>(so_far + *index);
        }
        const auto beyond = [&](std::string_view expected) {
            line_.fail(fmt::format("the {} {} in the corner {}", part_names[part], *index, in_quotes(word)),
                       expected);
        };
        if (*index == 0) beyond("1 or more, or a negative number");
        if (*index >= none) beyond("a smaller number");
        const auto positive = static_cast<std::uint64_t>(*index);
        if (positive > greatest_[part].index) greatest_[part] = {positive, line_.number()};
        return static_cast<std::uint32_t>(positive - 1);
    }

    void check_forward_references() const {
        for (const Part part : {vertex, texture, normal}) {
            const auto [index, at] = greatest_[part];
            if (index > count_of(part))
                throw trace::DataError(fmt::format(
                    "{}: line {}: found the {} {}, expected {}", source_.file, at, part_names[part], index,
                    count_of(part) > 0 ? fmt::format("1 to {}", count_of(part)) : "none: the file has none"));
        }
    }

    // Vertices are the pairs of a position and a normal that corners name, by their first appearance.
    void make_surface() {
        Faces faces;
        faces.ends = std::move(ends_);
        faces.corners.reserve(corners_.size());
        Surface& surface = mesh_.surface;
        if (std::none_of(corners_.begin(), corners_.end(),
                         [](const Corner& c) { return c.normal != none; })) {
            for (const Corner& c : corners_) faces.corners.push_back(c.vertex);
            surface.vertices = std::move(vertices_);
            surface.normals.resize(surface.vertices.size());
            if (smoothing_lines_ > 0)
                notes_.add("smoothing groups (s) are not read: faces without normals are flat",
                           smoothing_lines_);
        } else {
            number_pairs(faces.corners);
        }
        const auto refuse = [&](std::size_t face, const std::string& found, const std::string& expected) {
            throw trace::DataError(fmt::format("{}: line {}: found {}, expected {}", source_.file,
                                               face_line_[face], found, expected));
        };
        FaceTriangles filled = triangles_of(faces, surface.vertices, refuse, notes_);
        surface.triangles = std::move(filled.triangles);
        face_of_triangle_ = std::move(filled.face);
        mesh_.degenerate_faces = filled.too_few_corners;
    }

    void number_pairs(std::vector<std::uint32_t>& numbers) {
        std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
        for (const Corner& c : corners_)
            order.emplace_back(std::uint64_t{c.vertex} << 32 | c.normal,
                               static_cast<std::uint32_t>(order.size()));
        std::sort(order.begin(), order.end());
        // Each corner gets the first corner with its pair, and then that one's number.
        numbers.resize(corners_.size());
        for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
            if (order[i].first != order[first].first) first = i;
            numbers[order[i].second] = order[first].second;
        }
        Surface& surface = mesh_.surface;
        for (std::uint32_t c = 0; c < corners_.size(); ++c) {
            if (numbers[c] != c) {
                numbers[c] = numbers[numbers[c]];
                continue;
            }
            numbers[c] = static_cast<std::uint32_t>(surface.vertices.size());
            surface.vertices.push_back(vertices_[corners_[c].vertex]);
            surface.normals.push_back(corners_[c].normal == none ? Vec3{} : normals_[corners_[c].normal]);
        }
    }

    void make_materials() {
        std::vector<Material> described;
        for (const std::string& name : libraries_) {
            // A library that the file names itself does not stand in for another one.
            const std::string own = source_.stem + ".mtl";
            const bool is_named = std::find(libraries_.begin(), libraries_.end(), own) != libraries_.end();
            const bool takes_own = !source_.has_beside(name) && !source_.stem.empty() && !is_named;
            const std::string& there = takes_own ? own : name;
            if (!source_.has_beside(there)) {
                notes_.add(fmt::format("the material library {} is not there", in_quotes(name)));
                mesh_.missing_libraries.push_back(name);
                continue;
            }
            if (there != name)
                notes_.add(fmt::format("the material library {} is not there, {} is read in its place",
                                       in_quotes(name), in_quotes(there)));
            const Neighbour library = source_.read_beside(there);
            std::vector<Material> more = read_mtl(library.bytes, library.file, notes_);
            std::move(more.begin(), more.end(), std::back_inserter(described));
        }
        std::map<std::string_view, std::size_t> by_name;  // The last of a name.
        for (std::size_t m = 0; m < described.size(); ++m)
            if (!by_name.insert_or_assign(described[m].name, m).second)
                notes_.add("materials that are defined twice are read as the last of the name says");

        std::vector<bool> is_used(used_materials_.size() + 1);
        const auto index_of = [&](std::uint32_t material) {
            return material == none ? used_materials_.size() : material;
        };
        for (const std::uint32_t face : face_of_triangle_) {
            mesh_.triangle_material.push_back(static_cast<std::uint32_t>(index_of(face_material_[face])));
            is_used[mesh_.triangle_material.back()] = true;
            mesh_.triangle_group.push_back(face_group_[face]);
        }
        for (std::size_t m = 0; m < used_materials_.size(); ++m) {
            const auto found = by_name.find(used_materials_[m]);
            if (found != by_name.end()) {
                mesh_.materials.push_back(described[found->second]);
                continue;
            }
            mesh_.materials.push_back(
                {.name = used_materials_[m], .terms = MtlTerms{}, .emission = {}, .is_described = false});
            if (is_used[m]) notes_.add("materials that no library describes are grey");
        }
        if (is_used.back())
            mesh_.materials.push_back({.name = "default", .terms = MtlTerms{}, .emission = {}});
    }

    const Source& source_;
    TextLines line_;
    Notes notes_;
    Mesh mesh_;
    std::vector<Vec3> vertices_, normals_;
    std::array<std::uint64_t, 2> counts_{};  // Vertices, texture coordinates.
    std::array<Reference, 3> greatest_{};
    std::vector<Corner> corners_;
    std::vector<std::uint32_t> ends_, face_line_, face_material_, face_group_, face_of_triangle_;
    std::map<std::string, std::uint32_t, std::less<>> material_names_, group_names_;
    std::vector<std::string> used_materials_, libraries_;
    std::uint32_t material_ = none;
    std::uint32_t group_ = entry_of(group_names_, mesh_.groups, "");
    std::uint64_t smoothing_lines_ = 0;
};

}  // namespace

Mesh read_obj(const Source& source) {
    return ObjReader(source).read();
}

}  // namespace regather::meshes
