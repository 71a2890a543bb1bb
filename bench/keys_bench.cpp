// bench/keys_bench.cpp -- codes along space-filling curves: ways to compute them, 2^20 cells, one thread.
// Each run checks its codes: those of our Hilbert curve and of Morton's against each other, those of
// Skilling's curve, which is another one of the Hilbert curves, by turning them back.
#include <benchmark/benchmark.h>
#include <immintrin.h>

#include <array>
#include <cstdint>
#include <vector>

#include "reorder/cell_block.h"
#include "reorder/curve.h"

namespace {

using namespace regather;
using reorder::Cell, reorder::CellBlock;

constexpr std::size_t count = 1 << 20;

const std::vector<CellBlock>& cells(std::uint32_t bits) {
    static const std::array<std::vector<CellBlock>, reorder::max_curve_bits + 1> all = [] {
        std::array<std::vector<CellBlock>, reorder::max_curve_bits + 1> made;
        for (const std::uint32_t b : {10u, 21u}) {
            made[b].resize(count / CellBlock::cells);
            std::uint64_t state = 1;
            const auto next = [&] {
                state = state * 6364136223846793005u + 1442695040888963407u;
                return static_cast<std::uint32_t>(state >> (64 - b));
            };
            for (CellBlock& block : made[b])
                for (std::size_t i = 0; i < CellBlock::cells; ++i)
                    block.x[i] = next(), block.y[i] = next(), block.z[i] = next();
        }
        return made;
    }();
    return all[bits];
}

/// As published (AIP Conference Proceedings 707, 2004): the cell becomes the code's transpose.
Cell axes_to_transpose(Cell x, std::uint32_t bits) {
    for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1) {
        const std::uint32_t p = q - 1;
        for (int i = 0; i < 3; ++i) {
            if (x[i] & q) {
                x[0] ^= p;
            } else {
                const std::uint32_t t = (x[0] ^ x[i]) & p;
                x[0] ^= t;
                x[i] ^= t;
            }
        }
    }
    for (int i = 1; i < 3; ++i) x[i] ^= x[i - 1];
    std::uint32_t t = 0;
    for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
        if (x[2] & q) t ^= q - 1;
    for (int i = 0; i < 3; ++i) x[i] ^= t;
    return x;
}

Cell transpose_to_axes(Cell x, std::uint32_t bits) {
    const std::uint32_t end = 2u << (bits - 1);
    const std::uint32_t gray = x[2] >> 1;
    for (int i = 2; i > 0; --i) x[i] ^= x[i - 1];
    x[0] ^= gray;
    for (std::uint32_t q = 2; q != end; q <<= 1) {
        const std::uint32_t p = q - 1;
        for (int i = 2; i >= 0; --i) {
            if (x[i] & q) {
                x[0] ^= p;
            } else {
                const std::uint32_t t = (x[0] ^ x[i]) & p;
                x[0] ^= t;
                x[i] ^= t;
            }
        }
    }
    return x;
}

std::uint64_t deposited(const Cell& cell) {
    return _pdep_u64(cell[0], 0x4924924924924924) | _pdep_u64(cell[1], 0x2492492492492492) |
           _pdep_u64(cell[2], 0x1249249249249249);
}

/// Codes of all cells by `code`, compared with `expected` of each cell.
template <class Code, class Expected>
void measure(benchmark::State& state, Code&& code, Expected&& expected) {
    const auto bits = static_cast<std::uint32_t>(state.range(0));
    const std::vector<CellBlock>& blocks = cells(bits);
    std::vector<std::uint64_t> codes(count);
    for (auto unused : state) {
        for (std::size_t b = 0; b < blocks.size(); ++b) code(blocks[b], bits, &codes[b * CellBlock::cells]);
        benchmark::DoNotOptimize(codes.data());
        benchmark::ClobberMemory();
    }
    for (std::size_t i = 0; i < count; ++i) {
        const CellBlock& block = blocks[i / CellBlock::cells];
        const std::size_t lane = i % CellBlock::cells;
        if (codes[i] != expected(Cell{block.x[lane], block.y[lane], block.z[lane]}, bits, codes[i])) {
            state.SkipWithError("wrong code");
            return;
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
}

/// `code` of one cell at a time.
template <class Code>
auto one_by_one(Code&& code) {
    return [code](const CellBlock& block, std::uint32_t bits, std::uint64_t* codes) {
        for (std::size_t i = 0; i < CellBlock::cells; ++i)
            codes[i] = code(Cell{block.x[i], block.y[i], block.z[i]}, bits);
    };
}

constexpr auto by_table = [](const Cell& cell, std::uint32_t bits, std::uint64_t = 0) {
    return reorder::hilbert_code(reorder::morton_code(cell), bits);
};

void hilbert_as_published_by_skilling(benchmark::State& state) {
    measure(state, one_by_one([](const Cell& cell, std::uint32_t bits) {
                return reorder::morton_code(axes_to_transpose(cell, bits));
            }),
            [](const Cell& cell, std::uint32_t bits, std::uint64_t code) {
                Cell transpose{};
                for (std::uint32_t bit = 0; bit < 3 * bits; ++bit)
                    transpose[2 - bit % 3] |= static_cast<std::uint32_t>(code >> bit & 1) << bit / 3;
                return transpose_to_axes(transpose, bits) == cell ? code : ~code;
            });
}

void hilbert_by_table(benchmark::State& state) {
    measure(state, one_by_one(by_table), [](const Cell& cell, std::uint32_t bits, std::uint64_t) {
        CellBlock block;
        block.x[0] = cell[0], block.y[0] = cell[1], block.z[0] = cell[2];
        reorder::turn_along_hilbert(block, bits);
        return reorder::morton_code({block.x[0], block.y[0], block.z[0]});
    });
}

void hilbert_by_lanes(benchmark::State& state) {
    measure(
        state,
        [](const CellBlock& cell_block, std::uint32_t bits, std::uint64_t* codes) {
            CellBlock block = cell_block;
            reorder::turn_along_hilbert(block, bits);
            for (std::size_t i = 0; i < CellBlock::cells; ++i)
                codes[i] = reorder::morton_code({block.x[i], block.y[i], block.z[i]});
        },
        by_table);
}

void morton_by_magic_bits(benchmark::State& state) {
    measure(state, one_by_one([](const Cell& cell, std::uint32_t) { return reorder::morton_code(cell); }),
            [](const Cell& cell, std::uint32_t, std::uint64_t) { return deposited(cell); });
}

void morton_by_pdep(benchmark::State& state) {
    measure(state, one_by_one([](const Cell& cell, std::uint32_t) { return deposited(cell); }),
            [](const Cell& cell, std::uint32_t, std::uint64_t) { return reorder::morton_code(cell); });
}

#define KEYS(function) BENCHMARK(function)->ArgName("bits")->Arg(10)->Arg(21)->Unit(benchmark::kMillisecond)
KEYS(hilbert_as_published_by_skilling);
KEYS(hilbert_by_table);
KEYS(hilbert_by_lanes);
KEYS(morton_by_magic_bits);
KEYS(morton_by_pdep);

}  // namespace

BENCHMARK_MAIN();
