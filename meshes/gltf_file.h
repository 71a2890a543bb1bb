// meshes/gltf_file.h -- a glTF 2.0 file (Khronos Group, "glTF 2.0 Specification"): its JSON, and the bytes of
// its buffers, from the chunk of a .glb, from data URIs and from files beside it.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "meshes/mesh.h"
#include "meshes/notes.h"
#include "trace/field.h"

namespace regather::meshes {

class GltfFile {
public:
    /// URIs of buffers are data URIs in base64 or relative names, which may lead out of the folder ("../");
    /// other schemes and absolute names are refused. Throws trace::DataError for what is damaged, cut, of
    /// another version, requires an extension that is not known here, or declares more than is there.
    GltfFile(const Source& source, Notes& notes);

    const trace::Field& root() const { return root_; }
    /// All elements of a list of the file, such as "nodes"; none when it has no such list.
    const std::vector<trace::Field>& list(const std::string& name) const;
    /// The element of that list that `index`, a whole number in the file, names. Refuses one that is not
    /// there.
    const trace::Field& element(const std::string& list_name, const trace::Field& index) const;
    std::size_t index(const std::string& list_name, const trace::Field& index) const;

    /// The bytes of an element of "bufferViews".
    std::string_view view(const trace::Field& buffer_view) const;

private:
    void check_version() const;
    void check_extensions() const;
    void open_buffers(const Source& source);
    std::shared_ptr<const std::string> bytes_of(const Source& source, const trace::Field& uri);

    std::string_view chunk_;
    bool has_chunk_ = false;
    std::unique_ptr<trace::Document> document_;
    trace::Field root_;
    mutable std::map<std::string, std::vector<trace::Field>, std::less<>> lists_;
    std::map<std::string, std::shared_ptr<const std::string>> read_;  // By URI.
    std::vector<std::shared_ptr<const std::string>> kept_;
    std::vector<std::string_view> buffers_;
};

}  // namespace regather::meshes
