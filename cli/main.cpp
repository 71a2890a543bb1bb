// cli/main.cpp -- the binary `regather`.
#include <cstdio>

#include "cli/command_line.h"

int main(int argc, char** argv) {
    return regather::cli::run({stdout, stderr, {argv, argv + argc}});
}
