// reorder/shared_library.h -- an ordering from a user's shared library; the C interface is reorder/plugin.h.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "reorder/ordering.h"

namespace regather::reorder {

/// Throws trace::UsageError, one line that names the file, when it is missing, damaged, of another ABI or
/// without one of the functions; assign_keys() does when the library refuses. Loading a library runs its
/// code: load what you trust.
class SharedLibrary final : public Ordering {
public:
    SharedLibrary(const std::filesystem::path& path, std::string parameters);
    ~SharedLibrary() override;
    SharedLibrary(const SharedLibrary&) = delete;
    SharedLibrary& operator=(const SharedLibrary&) = delete;

    const std::string& name() const { return name_; }  ///< As the library calls its ordering.
    const std::string& parameters() const { return parameters_; }
    const std::filesystem::path& path() const { return path_; }
    /// Nobody knows what it looks at: it is given all that there is.
    Reads reads() const override { return {.captured = true}; }
    Cost assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                     std::span<std::uint64_t> keys) const override;

private:
    struct Functions;
    std::filesystem::path path_;
    std::string parameters_, name_;
    std::unique_ptr<Functions> functions_;
};

}  // namespace regather::reorder
