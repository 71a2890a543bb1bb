// cli/cpu.cpp -- refuses a CPU that has not what all other files are compiled for, x86-64-v3, before any of
// their code runs: without this the process would end in SIGILL. This file alone is compiled for any x86-64.
#include <unistd.h>

#include <cstring>

namespace {

// Priority 101 is before the initialisers of all static objects. The compilers know no name for all of
// x86-64-v3; every CPU that has these four has the rest of it.
[[gnu::constructor(101)]] void refuse_old_cpu() {
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
        __builtin_cpu_supports("fma"))
        return;
    const char* const line =
        "regather: found a CPU without AVX2, BMI or FMA, expected x86-64-v3: "
        "any of Intel since Haswell (2013), of AMD since Zen (2017)\n";
    // Nothing of the library but the call itself.
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line, std::strlen(line));
    ::_exit(1);
}

}  // namespace
