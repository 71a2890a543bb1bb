// tests/cli/command.h -- runs the binary as a user's shell would: argument vector in, exit code and both
// outputs out. Nothing hangs: after a minute a run is killed.
#pragma once
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/scratch.h"
#include "trace/file.h"

namespace regather::cli {

struct Outcome {
    int exit_code = -1;  ///< -1: killed.
    bool timed_out = false;
    std::string out, err;
};

/// The binary with these words. `kill_after`: SIGKILL when it still runs then. `out`: where stdout goes
/// instead of Outcome.
inline Outcome regather(std::vector<std::string> words,
                        std::optional<std::chrono::milliseconds> kill_after = {}, const char* out = nullptr) {
    using Clock = std::chrono::steady_clock;
    const Scratch scratch;
    const std::string out_path = out ? out : (scratch / "out").string(),
                      err_path = (scratch / "err").string();
    words.insert(words.begin(), REGATHER_BINARY);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_path.c_str(), O_WRONLY | O_CREAT, 0666);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err_path.c_str(), O_WRONLY | O_CREAT, 0666);
    pid_t child = 0;
    const int failed = ::posix_spawn(&child, REGATHER_BINARY, &actions, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) throw std::runtime_error("cannot start " REGATHER_BINARY);

    const Clock::time_point start = Clock::now();
    const auto limit = kill_after.value_or(std::chrono::minutes(1));
    int status = 0;
    Outcome outcome;
    for (bool killed = false; ::waitpid(child, &status, WNOHANG) == 0;
         std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
        if (killed || Clock::now() - start < limit) continue;
        ::kill(child, SIGKILL);
        killed = true;
        outcome.timed_out = !kill_after.has_value();
    }
    if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
    if (!out) outcome.out = trace::read_file(out_path);
    outcome.err = trace::read_file(err_path);
    return outcome;
}

inline std::string content(const std::filesystem::path& path) {
    return trace::read_file(path);
}

inline void write(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

/// Every file below a folder, by its path within: to see what was changed, or that nothing was.
inline std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file())
            files[std::filesystem::relative(entry.path(), folder).string()] = content(entry.path());
    return files;
}

}  // namespace regather::cli
