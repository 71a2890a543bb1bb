// tests/cli/command.h -- the commands as a user's shell would run them: words in, exit code and both outputs
// out. In process, which takes no time; and the binary itself, for what concerns a process: signals, kills, a
// full disk.
#pragma once
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "cli/command_line.h"
#include "tests/scratch.h"
#include "trace/file.h"

namespace regather::cli {

struct Outcome {
    int exit_code = -1;  ///< Minus the signal that ended a process.
    std::string out, err;
};

inline std::string content(const std::filesystem::path& path) {
    return trace::read_file(path);
}

/// The command with these words, in this process.
inline Outcome regather(std::vector<std::string> words) {
    /// A stream into memory.
    struct Memory {
        char* bytes = nullptr;
        std::size_t size = 0;
        std::FILE* file = ::open_memstream(&bytes, &size);
        std::string taken() {
            std::fclose(file);
            std::string text(bytes, size);
            std::free(bytes);
            return text;
        }
    };
    Memory out, err;
    words.insert(words.begin(), "regather");
    const int exit_code = run({out.file, err.file, std::move(words)});
    return {exit_code, out.taken(), err.taken()};
}

/// The binary, started with these words.
class Process {
public:
    /// `out`: where stdout goes in place of Outcome.
    explicit Process(std::vector<std::string> words, const std::string& out = {})
        : out_(out.empty() ? (scratch_ / "out").string() : out), keeps_out_(out.empty()) {
        words.insert(words.begin(), REGATHER_BINARY);
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        const std::string err = (scratch_ / "err").string();
        posix_spawn_file_actions_t actions;
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_.c_str(), O_WRONLY | O_CREAT, 0666);
        ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT, 0666);
        const int failed = ::posix_spawn(&pid_, REGATHER_BINARY, &actions, nullptr, argv.data(), environ);
        ::posix_spawn_file_actions_destroy(&actions);
        if (failed != 0) throw std::runtime_error("cannot start " REGATHER_BINARY);
    }
    ~Process() {
        if (running()) {
            send(SIGKILL);
            ::waitpid(pid_, &status_, 0);
        }
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    bool running() {
        if (!ended_) ended_ = ::waitpid(pid_, &status_, WNOHANG) != 0;
        return !ended_;
    }
    void send(int signal) const { ::kill(pid_, signal); }
    /// Until something can be seen from outside; false when the process ends before.
    bool wait_until(const std::function<bool()>& seen) {
        while (running()) {
            if (seen()) return true;
            std::this_thread::sleep_for(std::chrono::microseconds(200));
        }
        return seen();
    }
    Outcome outcome() {
        while (running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return {WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_),
                keeps_out_ ? content(out_) : "", content(scratch_ / "err")};
    }

private:
    const Scratch scratch_;
    const std::string out_;
    const bool keeps_out_;
    pid_t pid_ = 0;
    int status_ = 0;
    bool ended_ = false;
};

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
