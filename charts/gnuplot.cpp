#include "charts/gnuplot.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "charts/lettering.h"

extern char** environ;

namespace regather::charts {
namespace {

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
// Files without a name instead of pipes: no deadlock when both sides have much to say, nothing left after a
// crash.
using File = std::unique_ptr<std::FILE, Close>;

File nameless_file() {
    File file(std::tmpfile());
    if (!file) throw std::runtime_error(fmt::format("gnuplot: no temporary file: {}", std::strerror(errno)));
    return file;
}

std::string content(const File& file) {
    std::rewind(file.get());
    std::string bytes;
    char block[1 << 16];
    while (const std::size_t got = std::fread(block, 1, sizeof block, file.get())) bytes.append(block, got);
    return bytes;
}

/// gnuplot's complaint without the place in a script that nobody sees: its last line that says something.
std::string complaint(const std::string& text) {
    std::string last;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::size_t word = text.find_first_not_of(" \t^", at);
        if (word < end) last = text.substr(word, end - word);
        at = end + 1;
    }
    return last.empty() ? "no reason given" : last;
}

}  // namespace

std::string run_gnuplot(std::string_view script) {
    const File in = nameless_file(), out = nameless_file(), complaints = nameless_file();
    if (std::fwrite(script.data(), 1, script.size(), in.get()) != script.size() || std::fflush(in.get()) != 0)
        throw std::runtime_error(fmt::format("gnuplot: script cannot be stored: {}", std::strerror(errno)));
    std::rewind(in.get());

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, fileno(in.get()), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(out.get()), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(complaints.get()), STDERR_FILENO);
    char name[] = "gnuplot", no_settings[] = "-d", from_stdin[] = "-";
    char* const arguments[] = {name, no_settings, from_stdin, nullptr};
    pid_t child = 0;
    const int error = posix_spawnp(&child, name, &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error == ENOENT)
        throw std::runtime_error("gnuplot: not found in PATH; charts need the Debian package gnuplot-nox");
    if (error != 0)
        throw std::runtime_error(fmt::format("gnuplot: cannot be started: {}", std::strerror(error)));

    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) throw std::runtime_error(fmt::format("gnuplot: lost: {}", std::strerror(errno)));
    if (WIFSIGNALED(status))
        throw std::runtime_error(fmt::format("gnuplot: killed by signal {}", WTERMSIG(status)));
    if (WEXITSTATUS(status) != 0)
        throw std::runtime_error(
            fmt::format("gnuplot: exit code {}: {}", WEXITSTATUS(status), complaint(content(complaints))));
    return content(out);
}

std::string gnuplot_string(std::string_view text) {
    std::string out = "'";
    for (const char c : drawable(text)) {
        // gnuplot 5.4 fails on some strings with a doubled quote: the typographic one looks the same.
        if (c == '\'')
            out += "\xE2\x80\x99";
        else
            out += c;
    }
    return out + '\'';
}

}  // namespace regather::charts
