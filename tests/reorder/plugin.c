/* plugin.c -- shared libraries with a defect each, one that states costs, one that needs every column; for shared_library_test.cpp. */
#include "reorder/plugin.h"

#ifdef PLUGIN_other_abi
uint32_t regather_plugin_abi(void) { return REGATHER_PLUGIN_ABI + 1; }
#else
uint32_t regather_plugin_abi(void) { return REGATHER_PLUGIN_ABI; }
#endif

#ifdef PLUGIN_bad_name
const char* regather_ordering_name(void) { return "two,cells"; }
#else
const char* regather_ordering_name(void) { return "test"; }
#endif

#ifndef PLUGIN_no_assign_keys
int regather_assign_keys(const struct regather_workload* work, const char* parameters, uint64_t* keys) {
    (void)parameters;
    for (uint64_t i = 0; i < work->count; ++i) keys[i] = work->count - i;
#if defined(PLUGIN_refusing)
    return 7;
#elif defined(PLUGIN_columns)
    return !work->direction || !work->leaf_kd || !work->leaf_bvh;
#else
    return 0;
#endif
}
#endif

#ifdef PLUGIN_costed
void regather_cost(const struct regather_workload* work, const char* parameters, uint64_t onchip_bytes,
                   struct regather_cost_counts* cost) {
    (void)parameters;
    cost->keys = work->count;
    cost->buffered_bytes = onchip_bytes + 1;
    cost->stalls = work->leaf_kd != 0;
}
#endif
