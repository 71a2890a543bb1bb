#include "cli/fault.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace regather::cli {

namespace {

// A handler may call only what is async-signal-safe: open, read, write and _exit are, so the file that is
// mapped at an address is looked up in /proc/self/maps, line by line.
constexpr int bad_data = 3;
char maps[1 << 20];

void print(std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
        if (written <= 0) return;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

/// The number that opens `text`, which is left behind it.
std::uintptr_t hexadecimal(std::string_view& text) {
    std::uintptr_t value = 0;
    while (!text.empty()) {
        const char c = text.front();
        const int digit = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
        if (digit < 0) break;
        value = value << 4 | static_cast<std::uintptr_t>(digit);
        text.remove_prefix(1);
    }
    return value;
}

/// The path of the file that is mapped at `address`; empty when none is.
std::string_view mapped_at(std::uintptr_t address) {
    const int file = ::open("/proc/self/maps", O_RDONLY | O_CLOEXEC);
    if (file < 0) return {};
    std::size_t filled = 0;
    while (filled < sizeof maps) {
        const ssize_t got = ::read(file, maps + filled, sizeof maps - filled);
        if (got <= 0) break;
        filled += static_cast<std::size_t>(got);
    }
    ::close(file);
    std::string_view left(maps, filled);
    while (!left.empty()) {
        const std::size_t end = left.find('\n');
        std::string_view line = left.substr(0, end);
        left.remove_prefix(end == left.npos ? left.size() : end + 1);
        const std::string_view whole = line;
        const std::uintptr_t first = hexadecimal(line);
        if (line.empty()) continue;
        line.remove_prefix(1);  // '-'
        const std::uintptr_t behind = hexadecimal(line);
        const std::size_t path = whole.find('/');
        if (first <= address && address < behind)
            return path == whole.npos ? std::string_view{} : whole.substr(path);
    }
    return {};
}

extern "C" void bus_error(int signal, siginfo_t* info, void*) {
    const std::string_view path = info->si_code == BUS_ADRERR
                                      ? mapped_at(reinterpret_cast<std::uintptr_t>(info->si_addr))
                                      : std::string_view{};
    if (path.empty()) {  // not a file's fault
        ::signal(signal, SIG_DFL);
        ::raise(signal);
        return;
    }
    print("regather: ");
    print(path);
    print(": found a file that was cut short while it was read, expected the file as it was opened\n");
    ::_exit(bad_data);
}

}  // namespace

void tell_file_faults() {
    struct sigaction action {};
    action.sa_sigaction = bus_error;
    action.sa_flags = SA_SIGINFO;
    ::sigemptyset(&action.sa_mask);
    ::sigaction(SIGBUS, &action, nullptr);
    ::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace regather::cli
