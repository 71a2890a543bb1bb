/* reorder/plugin.h -- the C interface of an ordering that a user compiles on their own as a shared library.
 * Plain C (C99). The library exports regather_plugin_abi, regather_ordering_name and regather_assign_keys,
 * and may export regather_cost. examples/by_height.c is a whole one. regather calls from one thread at a
 * time. */
#ifndef REGATHER_REORDER_PLUGIN_H
#define REGATHER_REORDER_PLUGIN_H
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Goes up whenever a struct or function below changes; regather refuses a library that returns another
 * number. */
#define REGATHER_PLUGIN_ABI 1u

#if defined(__GNUC__)
#define REGATHER_EXPORT __attribute__((visibility("default")))
#else
#define REGATHER_EXPORT
#endif

/* The queries in capture order: pixels in row order, the samples of a pixel together. A column that was not
 * captured is NULL. Read only; valid during the call. */
struct regather_workload {
    uint32_t abi_version;     /* REGATHER_PLUGIN_ABI */
    uint64_t count;           /* queries; at most 2^32 - 1 */
    const float* position;    /* 3 a query, x y z [scene units]; may hold NaN or infinity */
    const float* direction;   /* 3 a query: of the gather ray that ended here, unit length; or NULL */
    const uint32_t* pixel;    /* y * image_width + x */
    const uint32_t* leaf_kd;  /* leaf label: kd-tree over the triangles; or NULL */
    const uint32_t* leaf_bvh; /* leaf label: BVH over the triangles; or NULL */
    uint32_t image_width, image_height; /* [pixels] */
    float bounds_min[3], bounds_max[3]; /* of all finite positions; min > max when there is none */
};

/* What a machine would spend on this order; reorder/ordering.h says what each counts. */
struct regather_cost_counts {
    uint64_t keys, key_ops, sort_passes, moved_records, buffered_bytes, reorder_bytes, recast_rays, stalls;
};

/* Returns REGATHER_PLUGIN_ABI. */
REGATHER_EXPORT uint32_t regather_plugin_abi(void);

/* Letters, digits, '-', '_', '+' and '.', at most 64; it goes into the result files. */
REGATHER_EXPORT const char* regather_ordering_name(void);

/* Sets keys[0 .. count); smaller keys run first and equal keys keep capture order. A rank is a key.
 * `parameters` is what the user wrote after the library's name, or "". Returns 0, or any other number to
 * refuse (a parameter it does not know, a column it needs that is NULL). */
REGATHER_EXPORT int regather_assign_keys(const struct regather_workload* work, const char* parameters,
                                         uint64_t* keys);

/* Optional; without it all counts are 0. `cost` comes zeroed. */
REGATHER_EXPORT void regather_cost(const struct regather_workload* work, const char* parameters,
                                   uint64_t onchip_bytes, struct regather_cost_counts* cost);

#ifdef __cplusplus
}
#endif
#endif
