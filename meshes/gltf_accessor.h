// meshes/gltf_accessor.h -- the values that accessors of a glTF file describe (Khronos Group, "glTF 2.0
// Specification", section 3.6.2), sparse ones and those of KHR_mesh_quantization included.
#pragma once
#include <cstdint>
#include <vector>

#include "meshes/gltf_file.h"
#include "meshes/surface.h"

namespace regather::meshes {

/// Reads accessors, as often as they are named, within a budget of elements for the whole file.
class GltfAccessors {
public:
    explicit GltfAccessors(const GltfFile& file) : file_(file) {}

    /// The count that the accessor named by `index` declares, which fits its bytes.
    std::uint64_t count(const trace::Field& index) const;
    /// Of type VEC3: floats, or bytes and shorts, normalized or not. They may be anything but NaN and
    /// infinite.
    std::vector<Vec3> points(const trace::Field& index);
    /// Of type SCALAR: unsigned bytes, shorts or ints, each below `vertices`.
    std::vector<std::uint32_t> indices(const trace::Field& index, std::size_t vertices);

private:
    struct Elements {
        const char* data = nullptr;
        std::uint64_t count = 0, stride = 0;
    };
    Elements elements(const trace::Field& accessor, std::string_view type, std::size_t element_bytes) const;
    void replace_sparse(const trace::Field& sparse, std::uint32_t component, bool normalized,
                        std::vector<Vec3>& points) const;
    void spend(const trace::Field& accessor, std::uint64_t elements);

    const GltfFile& file_;
    std::uint64_t spent_ = 0;
};

}  // namespace regather::meshes
