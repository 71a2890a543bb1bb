/* by_height.c -- an ordering of one's own: queries from the lowest to the highest.
 * cc -shared -fPIC -I REGATHER_SOURCE examples/by_height.c -o by_height.so */
#include <string.h>

#include "reorder/plugin.h"

uint32_t regather_plugin_abi(void) { return REGATHER_PLUGIN_ABI; }
const char* regather_ordering_name(void) { return "by-height"; }

int regather_assign_keys(const struct regather_workload* work, const char* parameters, uint64_t* keys) {
    if (*parameters != '\0') return 1; /* has none */
    for (uint64_t i = 0; i < work->count; ++i) {
        /* Bits of floats order like integers once negative ones are flipped and positive ones lifted above them. */
        uint32_t bits;
        memcpy(&bits, &work->position[3 * i + 2], sizeof bits);
        keys[i] = bits >> 31 ? ~bits : bits | 0x80000000u;
    }
    return 0;
}
