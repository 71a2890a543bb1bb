#include "cli/commands.h"

namespace regather::cli {
namespace {

constexpr Subcommand table[] = {
    {"scenes", "list the scenes there are, show one, or draw a contact sheet", add_scenes},
    {"import", "make a scene of a home, a map, furniture or a mesh of others", add_import},
    {"capture", "render a scene; write its image and its trace", add_capture},
    {"reference", "render a scene by path tracing: the truth that images are measured against",
     add_reference},
    {"walk", "make a trace of your own photons and queries (.npy columns)", add_walk},
    {"replay", "put a trace's queries into orders; count misses and traffic", add_replay},
    {"frame", "rays and photon queries of one frame through one hierarchy, together and apart", add_frame},
    {"structures", "list the structures that a trace's queries can be searched in", add_structures},
    {"layouts", "list the layouts that a replay can choose: where each node lies in memory", add_layouts},
    {"detail", "tell apart which data misses in a cache, why, and when", add_detail},
    {"heatmap", "bytes moved by each pixel, by ordering, as an image", add_heatmap},
    {"race", "search a trace's queries on this machine in other orders, timed", add_race},
    {"sampling", "measure the error and the speed of set sampling against exact replays", add_sampling},
    {"cachesim", "simulate caches on an address trace of your own", add_cachesim},
    {"machines", "list the machines there are, or show one with the source of each figure", add_machines},
    {"chart", "draw charts (SVG and PNG) from CSV rows", add_chart},
    {"computation", "floating-point operations of a frame: the paper's Table 2, and of a capture",
     add_computation},
    {"converge", "measure error against run time over a ladder of settings", add_converge},
    {"stability", "measure errors in stiff and extreme cases against what is allowed", add_stability},
    {"run", "capture, reorder, replay and chart what an experiment file asks for", add_run},
    {"results", "tell which rows a change of the renderer has outdated", add_results},
    {"info", "what a trace holds, or what a scene needs", add_info},
};

}  // namespace

std::span<const Subcommand> subcommands() {
    return table;
}

}  // namespace regather::cli
