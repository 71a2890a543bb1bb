// cli/main.cpp -- the binary `regather`. What concerns the whole process stands here, all else in
// cli/command_line.h.
#include <cstdio>

#include "cli/command_line.h"
#include "cli/fault.h"

int main(int argc, char** argv) {
    regather::cli::tell_file_faults();
    return regather::cli::run({stdout, stderr, {argv, argv + argc}});
}
