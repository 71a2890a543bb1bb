# The two commands of the README. Thin: CMake builds, the binary works.
#   make run    installs what is missing, builds the binary, runs the main job at a small scale
#   make test   the same for the tests, then all but the slow ones (make test-slow)
PRESET ?= release
OUT ?= out/room
FILTER ?= -LE slow
build = build/$(PRESET)

.PHONY: run test test-slow tests fuzz binary bench clean scenes-packages

run: binary
	$(build)/regather run scenes/experiments/room-small.json -o $(OUT)

test: tests
	ctest --preset $(PRESET) $(FILTER)

test-slow: tests
	ctest --preset $(PRESET) -L slow

binary:
	@cmake/install_packages.sh packages.txt
	cmake --preset $(PRESET) -D REGATHER_TESTS=OFF -D REGATHER_BENCHMARKS=OFF
	cmake --build --preset $(PRESET) --target regather

tests:
	@cmake/install_packages.sh packages.txt packages-test.txt
	cmake --preset $(PRESET) -D REGATHER_TESTS=ON -D REGATHER_BENCHMARKS=OFF
	cmake --build --preset $(PRESET)

# A minute for each reader; an input that ends badly is left in build/fuzz/fuzz/NAME.
fuzz:
	@cmake/install_packages.sh packages.txt packages-test.txt
	cmake --preset fuzz
	cmake --build --preset fuzz
	REGATHER_FUZZ_SECONDS=$(or $(SECONDS),60) ctest --preset fuzz

# Scenes of others, for `regather import`: 0.5 GB, and never needed by run or test.
scenes-packages:
	@cmake/install_packages.sh packages-scenes.txt

bench:
	@cmake/install_packages.sh packages.txt packages-bench.txt
	cmake --preset $(PRESET) -D REGATHER_TESTS=OFF -D REGATHER_BENCHMARKS=ON
	cmake --build --preset $(PRESET)
	bench/run.sh $(build)

clean:
	rm -rf build out
