// trace/folder_lock.h -- a folder that one process at a time writes into.
#pragma once
#include <filesystem>

#include "trace/descriptor.h"

namespace regather::trace {

/// Holds a folder (flock) until it is destroyed or the process ends, however it ends; nothing is left in the
/// folder. On a file system without locks it holds nothing.
class FolderLock {
public:
    /// Creates the folder if needed. Throws UsageError while another holds it, std::runtime_error when it
    /// cannot be created.
    explicit FolderLock(const std::filesystem::path& folder);

private:
    Descriptor folder_;
};

}  // namespace regather::trace
