# The control panel.
pixelflex_test(mirror_aim_test LABEL unit
  SOURCES unit/mirror_aim_test.cpp
  LINK pixelflex_panel pixelflex_test_support)

pixelflex_test(panel_test LABEL e2e TIMEOUT 240
  SOURCES e2e/panel_test.cpp e2e/panel_window.h e2e/device_room.h
  LINK pixelflex_test_support pixelflex_device_host pixelflex_store)
add_dependencies(panel_test pixelflex-calibrate pixelflex-new pixelflex-panel)

# Run by hand, see bench/README.md; the test sees that any clicks are survived.
add_executable(panel_bench bench/panel_bench.cpp)
target_link_libraries(panel_bench PRIVATE pixelflex_options pixelflex_test_support pixelflex_device_host pixelflex_store CLI11::CLI11
  fmt::fmt)
target_compile_definitions(panel_bench PRIVATE PIXELFLEX_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}"
  PIXELFLEX_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
add_dependencies(panel_bench pixelflex-calibrate pixelflex-panel)
set_target_properties(panel_bench PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
add_test(NAME panel_bench COMMAND panel_bench --seconds 5)
set_tests_properties(panel_bench PROPERTIES LABELS bench TIMEOUT 180 ENVIRONMENT "LIBGL_ALWAYS_SOFTWARE=1")
