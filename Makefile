# The two commands of the README. Thin: CMake builds, the binary works.
#   make run    installs what is missing, builds, runs the main job at a small scale
#   make test   the same set-up, then every test
PRESET ?= release
OUT ?= out/room

.PHONY: run test setup build bench clean scenes-packages

run: build
	build/$(PRESET)/regather run scenes/experiments/room-small.json -o $(OUT)

test: build
	ctest --preset $(PRESET)

build: setup
	cmake --preset $(PRESET)
	cmake --build --preset $(PRESET)

setup:
	@cmake/install_packages.sh packages.txt

# Scenes of others, for `regather import`: 0.5 GB, and never needed by run or test.
scenes-packages:
	@cmake/install_packages.sh packages-scenes.txt

bench: build
	bench/run.sh build/$(PRESET)

clean:
	rm -rf build out
