# Speed and memory: run by hand, see bench/README.md. The tests only see that they still work, on tiny input.
add_executable(calibrate_bench bench/calibrate_bench.cpp)
target_link_libraries(calibrate_bench PRIVATE pixelflex_options pixelflex_test_calibration pixelflex_test_support
  CLI11::CLI11 fmt::fmt)
target_compile_definitions(calibrate_bench PRIVATE PIXELFLEX_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
add_dependencies(calibrate_bench pixelflex-calibrate)
add_executable(geometry_bench bench/geometry_bench.cpp)
target_link_libraries(geometry_bench PRIVATE pixelflex_options pixelflex_geometry pixelflex_photometric
  benchmark::benchmark)
set_target_properties(calibrate_bench geometry_bench PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)

add_test(NAME calibrate_bench COMMAND calibrate_bench --tiny)
add_test(NAME geometry_bench COMMAND geometry_bench "--benchmark_filter=/(768|2)/" --benchmark_min_time=0.001
  --benchmark_format=json)
set_tests_properties(calibrate_bench geometry_bench PROPERTIES LABELS bench TIMEOUT 120)
