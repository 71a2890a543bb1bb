#include "reorder/shared_library.h"

#include <dlfcn.h>
#include <elf.h>
#include <fmt/format.h>

#include <cstring>

#include "reorder/plugin.h"
#include "trace/error.h"
#include "trace/file.h"
#include "trace/text.h"

namespace regather::reorder {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
    throw trace::UsageError(fmt::format("{}: {}", trace::shown(path.string(), trace::most_shown_path), why));
}

template <class Part>
bool read_at(std::string_view bytes, std::uint64_t place, Part& part) {
    if (place > bytes.size() || bytes.size() - place < sizeof part) return false;
    std::memcpy(&part, bytes.data() + place, sizeof part);
    return true;
}

/// The loader maps segments without looking at the file's length: a truncated library would end the process.
void check_segments(const std::filesystem::path& path) {
    std::error_code error;  // of a path that is too long
    if (!std::filesystem::is_regular_file(path, error))
        refuse(path, "no such file; expected a shared library");
    const std::string bytes = trace::read_file(path);
    Elf64_Ehdr header{};
    if (!read_at(bytes, 0, header) || !bytes.starts_with(ELFMAG) || header.e_phentsize != sizeof(Elf64_Phdr))
        refuse(path, "not a shared library");
    for (std::uint64_t i = 0; i < header.e_phnum; ++i) {
        Elf64_Phdr segment{};
        if (header.e_phoff > bytes.size() || !read_at(bytes, header.e_phoff + i * sizeof segment, segment) ||
            segment.p_filesz > bytes.size() || segment.p_offset > bytes.size() - segment.p_filesz)
            refuse(path,
                   fmt::format("damaged shared library: {} bytes, its segments need more", bytes.size()));
    }
}

bool printable(std::string_view name) {
    constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_+.";
    return !name.empty() && name.size() <= 64 && name.find_first_not_of(allowed) == std::string_view::npos;
}

const float* floats(std::span<const Vec3> column) {
    return column.empty() ? nullptr : reinterpret_cast<const float*>(column.data());
}

const std::uint32_t* labels(std::span<const std::uint32_t> column) {
    return column.empty() ? nullptr : column.data();
}

}  // namespace

struct SharedLibrary::Functions {
    struct Close {
        void operator()(void* opened) const { dlclose(opened); }
    };
    std::unique_ptr<void, Close> library;
    decltype(&regather_assign_keys) assign_keys = nullptr;
    decltype(&regather_cost) cost = nullptr;

    template <class Function>
    Function find(const char* symbol) const {
        return reinterpret_cast<Function>(dlsym(library.get(), symbol));
    }
    template <class Function>
    Function require(const std::filesystem::path& path, const char* symbol) const {
        const auto function = find<Function>(symbol);
        if (!function)
            refuse(path, fmt::format("function {} is missing; reorder/plugin.h lists them", symbol));
        return function;
    }
};

SharedLibrary::SharedLibrary(const std::filesystem::path& path, std::string parameters)
    : path_(path), parameters_(std::move(parameters)), functions_(std::make_unique<Functions>()) {
    check_segments(path);
    functions_->library.reset(dlopen(std::filesystem::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL));
    if (!functions_->library) {
        const char* why = dlerror();
        refuse(path, fmt::format("cannot be loaded: {}",
                                 why ? trace::shown(why, trace::most_shown_path) : "unknown reason"));
    }
    const std::uint32_t abi =
        functions_->require<decltype(&regather_plugin_abi)>(path, "regather_plugin_abi")();
    if (abi != REGATHER_PLUGIN_ABI)
        refuse(path, fmt::format("plug-in interface {}, this build has {}; compile it again", abi,
                                 REGATHER_PLUGIN_ABI));
    functions_->assign_keys =
        functions_->require<decltype(&regather_assign_keys)>(path, "regather_assign_keys");
    functions_->cost = functions_->find<decltype(&regather_cost)>("regather_cost");
    const char* name =
        functions_->require<decltype(&regather_ordering_name)>(path, "regather_ordering_name")();
    if (!name || !printable(name))
        refuse(path, "regather_ordering_name gives no name of 1 to 64 letters, digits, '-', '_', '+', '.'");
    name_ = name;
}

SharedLibrary::~SharedLibrary() = default;

Cost SharedLibrary::assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                                std::span<std::uint64_t> keys) const {
    const Bounds3& box = work.bounds;
    const regather_workload given{
        .abi_version = REGATHER_PLUGIN_ABI,
        .count = keys.size(),
        .position = floats(work.position),
        .direction = floats(work.direction),
        .pixel = labels(work.pixel),
        .leaf_kd = labels(work.leaf_kd),
        .leaf_bvh = labels(work.leaf_bvh),
        .image_width = work.image_width,
        .image_height = work.image_height,
        .bounds_min = {box.min.x, box.min.y, box.min.z},
        .bounds_max = {box.max.x, box.max.y, box.max.z},
    };
    if (const int status = functions_->assign_keys(&given, parameters_.c_str(), keys.data()); status != 0)
        refuse(path_, fmt::format("ordering {} refused with status {} (parameters {}, {} queries)", name_,
                                  status, trace::in_quotes(parameters_), keys.size()));
    regather_cost_counts counts{};
    if (functions_->cost) functions_->cost(&given, parameters_.c_str(), onchip_bytes, &counts);
    return {.keys = counts.keys,
            .key_ops = counts.key_ops,
            .sort_passes = counts.sort_passes,
            .moved_records = counts.moved_records,
            .buffered_bytes = counts.buffered_bytes,
            .reorder_bytes = counts.reorder_bytes,
            .recast_rays = counts.recast_rays,
            .stalls = counts.stalls};
}

}  // namespace regather::reorder
