# layers.cmake -- the one table of layers: which folder may include which, lowest first. CMakeLists.txt links by it, the test
# `layers` (tests/layers.cmake) holds every #include line against it, and docs/architecture.md shows it.
# A folder may always include itself. tests/ and bench/ may include anything, and nobody may include them.
set(regather_layers trace spatial cachesim meshes results scenes imports charts capture reorder replay experiment study cli)
set(trace_knows)
set(spatial_knows trace)
set(cachesim_knows trace)
set(meshes_knows trace)
set(results_knows trace)
set(scenes_knows meshes trace)
set(imports_knows scenes meshes trace)
set(charts_knows results trace)
set(capture_knows scenes meshes spatial trace)
set(reorder_knows spatial trace)
set(replay_knows reorder spatial cachesim trace)
set(experiment_knows charts results replay reorder capture scenes meshes spatial cachesim trace)
set(study_knows experiment charts results replay reorder capture scenes meshes spatial cachesim trace)
set(cli_knows study experiment charts results replay reorder capture imports scenes meshes spatial cachesim trace)
