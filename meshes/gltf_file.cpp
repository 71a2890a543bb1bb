#include "meshes/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "meshes/glb.h"
#include "trace/text.h"

namespace regather::meshes {

using trace::Field;
using trace::in_quotes;

namespace {

constexpr std::uint64_t most_bytes = 1ull << 30;

std::string_view without_mark(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return text;
}

// What a reader of triangles and factors may pass over when a file requires it.
bool is_known(std::string_view extension) {
    constexpr std::array<std::string_view, 4> names{"KHR_mesh_quantization", "KHR_texture_transform",
                                                    "KHR_texture_basisu", "KHR_lights_punctual"};
    return extension.starts_with("KHR_materials_") || extension.starts_with("EXT_texture_") ||
           extension.starts_with("KHR_xmp") ||
           std::find(names.begin(), names.end(), extension) != names.end();
}

std::unique_ptr<trace::Document> parsed(const Source& source, Notes& notes, std::string_view& chunk,
                                        bool& has_chunk) {
    std::string_view text = source.bytes;
    if (is_glb(text)) {
        const Glb glb = read_glb(text, source.file, notes);
        text = glb.json;
        has_chunk = glb.binary.has_value();
        chunk = glb.binary.value_or("");
    }
    return std::make_unique<trace::Document>(without_mark(text), source.file, "glTF");
}

}  // namespace

GltfFile::GltfFile(const Source& source, Notes& notes)
    : document_(parsed(source, notes, chunk_, has_chunk_)), root_(document_->root()) {
    check_version();
    check_extensions();
    open_buffers(source);
}

void GltfFile::check_version() const {
    if (!root_.value().is_object() || !root_.has("asset")) root_.fail("no asset", "a glTF 2.0 file");
    const Field asset = root_["asset"];
    const std::string& version = asset["version"].text("a version");
    if (version != "2" && !version.starts_with("2.")) asset["version"].fail(in_quotes(version), "glTF 2.0");
    if (const auto least = asset.get("minVersion"); least && least->text() != "2.0" && least->text() != "2")
        least->fail(in_quotes(least->text()), "glTF 2.0");
}

void GltfFile::check_extensions() const {
    for (const Field& extension : list("extensionsRequired"))
        if (!is_known(extension.text()))
            extension.fail("the required extension " + in_quotes(extension.text()), "a file without it");
}

void GltfFile::open_buffers(const Source& source) {
    std::uint64_t total = 0;
    for (const Field& buffer : list("buffers")) {
        const auto length = buffer["byteLength"].whole<std::uint64_t>(0, ~0ull, "a number of bytes");
        std::string_view bytes;
        if (const auto uri = buffer.get("uri")) {
            kept_.push_back(bytes_of(source, *uri));
            bytes = *kept_.back();
        } else if (buffers_.empty() && has_chunk_) {
            bytes = chunk_;
        } else {
            buffer.fail("a buffer without a uri", "one; only the first of a GLB with a BIN chunk has none");
        }
        if (bytes.size() < length)
            buffer["byteLength"].fail(fmt::format("{} for a buffer of {} bytes", length, bytes.size()),
                                      "no more than there are");
        if ((total += bytes.size()) > most_bytes)
            buffer.fail("more than 2^30 bytes of buffers", "at most as many");
        buffers_.push_back(bytes.substr(0, length));
    }
}

std::shared_ptr<const std::string> GltfFile::bytes_of(const Source& source, const Field& uri) {
    const std::string& text = uri.text("a URI");
    if (const auto found = read_.find(text); found != read_.end()) return found->second;
    std::string bytes;
    if (text.starts_with("data:")) {
        const std::size_t mark = text.find(";base64,");
        if (mark == text.npos) uri.fail("a data URI that is not in base64", "one that is");
        std::optional<std::string> content = from_base64(std::string_view(text).substr(mark + 8));
        if (!content) uri.fail("a data URI with damaged base64", "whole base64");
        bytes = std::move(*content);
    } else {
        if (leaves_the_disk_or_is_absolute(text))
            uri.fail(in_quotes(text), "a data URI, or a name relative to the file");
        std::string name = without_percent_codes(text);
        if (!source.has_beside(name)) name = text;  // Names with a percent sign that stands for itself.
        if (name.empty() || name.find('\0') != name.npos || !source.has_beside(name))
            uri.fail(in_quotes(text) + ", where no file is", "a file");
        bytes = source.read_beside(name).bytes;
    }
    return read_.emplace(text, std::make_shared<const std::string>(std::move(bytes))).first->second;
}

const std::vector<Field>& GltfFile::list(const std::string& name) const {
    const auto found = lists_.find(name);
    if (found != lists_.end()) return found->second;
    std::vector<Field> fields;
    if (const auto list = root_.get(name)) fields = list->elements();
    return lists_.emplace(name, std::move(fields)).first->second;
}

std::size_t GltfFile::index(const std::string& list_name, const Field& index) const {
    const std::size_t count = list(list_name).size();
    if (count == 0) index.fail(index.found(), fmt::format("none: the file has no {}", list_name));
    return index.whole<std::size_t>(0, count - 1,
                                    fmt::format("a whole number below {}, one of {}", count, list_name));
}

const Field& GltfFile::element(const std::string& list_name, const Field& index_field) const {
    return list(list_name)[index(list_name, index_field)];
}

std::string_view GltfFile::view(const Field& buffer_view) const {
    const std::string_view buffer = buffers_[index("buffers", buffer_view["buffer"])];
    const auto bytes = [&](const char* key) {
        const auto field = buffer_view.get(key);
        return field ? field->whole<std::uint64_t>(0, ~0ull, "a number of bytes") : 0;
    };
    const std::uint64_t start = bytes("byteOffset"), length = bytes("byteLength");
    if (start > buffer.size() || length > buffer.size() - start)
        buffer_view.fail(fmt::format("{} bytes at byte {}", length, start),
                         fmt::format("no more than the buffer's {}", buffer.size()));
    return buffer.substr(start, length);
}

}  // namespace regather::meshes
