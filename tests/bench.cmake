# Speed and memory: run by hand, see bench/README.md. The tests only see that they still work, on tiny input.
add_executable(calibrate_bench bench/calibrate_bench.cpp)
target_link_libraries(calibrate_bench PRIVATE pixelflex_options pixelflex_test_calibration pixelflex_test_support
  CLI11::CLI11 fmt::fmt)
target_compile_definitions(calibrate_bench PRIVATE PIXELFLEX_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
add_dependencies(calibrate_bench pixelflex-calibrate)
add_executable(geometry_bench bench/geometry_bench.cpp)
target_link_libraries(geometry_bench PRIVATE pixelflex_options pixelflex_geometry pixelflex_photometric
  benchmark::benchmark)
pkg_check_modules(VNCSERVER REQUIRED IMPORTED_TARGET libvncserver)
add_executable(day_bench bench/day_bench.cpp bench/busy_desktop.cpp bench/busy_desktop.h bench/viewer_run.cpp
  bench/viewer_run.h)
add_executable(reconnect_bench bench/reconnect_bench.cpp bench/viewer_run.cpp bench/viewer_run.h)
target_link_libraries(day_bench PRIVATE PkgConfig::VNCSERVER)
foreach(name day_bench reconnect_bench)
  target_link_libraries(${name} PRIVATE pixelflex_options pixelflex_test_support CLI11::CLI11 fmt::fmt)
  target_compile_definitions(${name} PRIVATE PIXELFLEX_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
  add_dependencies(${name} pixelflex-new pixelflex-view)
endforeach()
add_executable(scene_client bench/scene_client.cpp)
target_link_libraries(scene_client PRIVATE pixelflex_options pixelflex_image PkgConfig::X11)
add_executable(decode_bench bench/decode_bench.cpp bench/replay_server.cpp bench/replay_server.h
  bench/rfb_recording.cpp bench/rfb_recording.h bench/unix_socket.cpp bench/unix_socket.h)
target_link_libraries(decode_bench PRIVATE pixelflex_options pixelflex_test_support CLI11::CLI11 fmt::fmt)
target_compile_definitions(decode_bench PRIVATE PIXELFLEX_SCENE_CLIENT="${CMAKE_BINARY_DIR}/tests/scene_client")
add_dependencies(decode_bench scene_client)
add_executable(redraw_bench bench/redraw_bench.cpp bench/curves.cpp bench/curves.h)
target_link_libraries(redraw_bench PRIVATE pixelflex_options pixelflex_image pixelflex_renderer pixelflex_reference CLI11::CLI11
  fmt::fmt opencv_core opencv_imgproc PkgConfig::EPOXY)
target_include_directories(redraw_bench SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
# The headless viewer's own loop runs inside, so that its frame can be looked at.
set(viewer_programs ${PROJECT_SOURCE_DIR}/viewer/programs)
add_executable(latency_bench bench/latency_bench.cpp bench/marks.cpp bench/marks.h bench/watched_screen.cpp
  bench/watched_screen.h ${viewer_programs}/wall_view.cpp ${viewer_programs}/wall_reloader.cpp
  ${viewer_programs}/lost_picture.cpp ${viewer_programs}/desk_texts.cpp ${viewer_programs}/view_security.cpp
  ${viewer_programs}/password.cpp ${viewer_programs}/private_file.cpp)
target_link_libraries(latency_bench PRIVATE pixelflex_options pixelflex_test_support pixelflex_plan pixelflex_vnc
  pixelflex_x11source pixelflex_renderer pixelflex_store CLI11::CLI11 fmt::fmt X11::X11 PkgConfig::EPOXY)
target_compile_definitions(latency_bench PRIVATE PIXELFLEX_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
add_dependencies(latency_bench pixelflex-new pixelflex-view)
add_executable(viewer_bench bench/viewer_bench.cpp bench/desktop_client.cpp bench/desktop_client.h bench/measured_viewer.cpp bench/measured_viewer.h bench/thread_times.cpp bench/thread_times.h)
target_link_libraries(viewer_bench PRIVATE pixelflex_options pixelflex_store pixelflex_test_calibration pixelflex_test_support
  pixelflex_tiles CLI11::CLI11 fmt::fmt X11::X11)
target_compile_definitions(viewer_bench PRIVATE PIXELFLEX_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
add_dependencies(viewer_bench pixelflex-new pixelflex-view)
set_target_properties(viewer_bench calibrate_bench geometry_bench day_bench decode_bench latency_bench reconnect_bench redraw_bench scene_client
  PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)

add_test(NAME calibrate_bench COMMAND calibrate_bench --tiny)
add_test(NAME geometry_bench COMMAND geometry_bench "--benchmark_filter=/(768|2)/" --benchmark_min_time=0.001
  --benchmark_format=json)
add_test(NAME day_bench COMMAND day_bench --updates 4000 --resize-every 200 --most-growth 5)
add_test(NAME decode_bench COMMAND decode_bench --width 800 --height 600 --record 0.5 --passes 1)
add_test(NAME latency_bench COMMAND latency_bench --width 800 --height 600 --rounds 1 --updates 30)
add_test(NAME viewer_bench COMMAND viewer_bench --tiny --starts 1 --seconds 0.5)
add_test(NAME redraw_bench COMMAND redraw_bench --rounds 1 --tiny --curves redraw-curves.svg)
add_test(NAME reconnect_bench COMMAND reconnect_bench --returns 2)
set_tests_properties(viewer_bench calibrate_bench geometry_bench day_bench decode_bench latency_bench redraw_bench reconnect_bench
  PROPERTIES LABELS bench TIMEOUT 180)
