# 3D models: files, drawing, accuracy on simulated walls, the program.
pixelflex_test(model_scene_test LABEL unit SOURCES unit/model_scene_test.cpp unit/model_bad_files_test.cpp unit/model_files.h support/temporary_folder.cpp
  LINK pixelflex_scene)
# What a model's file may hold, by clang++ (preset fuzz): ./model_fuzz CORPUS -max_total_time=60
add_library(model_entry STATIC fuzz/model_entry.cpp support/temporary_folder.cpp)
target_link_libraries(model_entry PRIVATE pixelflex_options PUBLIC pixelflex_scene)
pixelflex_test(model_corpus_test LABEL unit SOURCES unit/model_corpus_test.cpp LINK model_entry)
if(PIXELFLEX_FUZZ)
  add_executable(model_fuzz fuzz/model_fuzz.cpp)
  target_link_libraries(model_fuzz PRIVATE pixelflex_options model_entry -fsanitize=fuzzer)
  add_dependencies(fuzzers model_fuzz)
endif()
pixelflex_test(model_depth_test LABEL gl SOURCES gl/model_depth_test.cpp LINK pixelflex_model)
pixelflex_test(model_light_test LABEL gl SOURCES gl/model_light_test.cpp gl/model_material_test.cpp LINK pixelflex_model)
pixelflex_test(model_stereo_test LABEL gl
  SOURCES gl/model_stereo_test.cpp support_calibration/plain_wall.cpp support_calibration/plain_wall.h
  LINK pixelflex_model_plan pixelflex_procedure)
pixelflex_test(model_navigation_test LABEL unit
  SOURCES unit/model_navigation_test.cpp ${PROJECT_SOURCE_DIR}/viewer/programs/model_navigation.cpp
    ${PROJECT_SOURCE_DIR}/viewer/programs/model_options.cpp ${PROJECT_SOURCE_DIR}/viewer/programs/model_tracker.cpp
  LINK pixelflex_model_plan)
pixelflex_test(model_wall_test LABEL gl TIMEOUT 300 SOURCES accuracy/model_wall_test.cpp
  LINK pixelflex_test_calibration pixelflex_test_support pixelflex_model_plan)
pixelflex_test(model_inset_test LABEL gl TIMEOUT 300 SOURCES accuracy/model_inset_test.cpp
  LINK pixelflex_test_calibration pixelflex_test_support pixelflex_model_plan)
pkg_check_modules(XRANDR REQUIRED IMPORTED_TARGET x11 xrandr)
pixelflex_library(pixelflex_test_outputs HEADERS support/dummy_xorg.h SOURCES support/dummy_xorg.cpp
  PUBLIC pixelflex_test_support PRIVATE PkgConfig::XRANDR)
pixelflex_test(gamma_keeper_test LABEL e2e SOURCES e2e/gamma_keeper_test.cpp LINK pixelflex_test_outputs pixelflex_display)
pixelflex_test(model_cli_test LABEL e2e TIMEOUT 240 SOURCES e2e/model_cli_test.cpp e2e/model_outputs_test.cpp e2e/model_windows_test.cpp
  LINK pixelflex_test_outputs pixelflex_image pixelflex_store)
add_dependencies(model_cli_test pixelflex-calibrate pixelflex-new pixelflex-model pixelflex-simulate)
add_executable(model_bench bench/model_bench.cpp)
target_link_libraries(model_bench PRIVATE pixelflex_options pixelflex_model CLI11::CLI11 fmt::fmt)
set_target_properties(model_bench PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
add_test(NAME model_bench COMMAND model_bench --triangles 20000 --rounds 1)
set_tests_properties(model_bench PROPERTIES LABELS bench TIMEOUT 180 ENVIRONMENT "LIBGL_ALWAYS_SOFTWARE=1")
