add_library(pixelflex_reference STATIC ${CMAKE_CURRENT_SOURCE_DIR}/reference/reference_warp.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/gl/plans.cpp)
target_link_libraries(pixelflex_reference PRIVATE pixelflex_options PUBLIC pixelflex_tiles pixelflex_renderer)

pixelflex_test(renderer_exact_test LABEL gl SOURCES gl/exact_test.cpp LINK pixelflex_renderer pixelflex_reference)
pixelflex_test(renderer_warp_test LABEL gl SOURCES gl/warp_test.cpp LINK pixelflex_renderer pixelflex_reference)
pixelflex_test(renderer_coverage_test LABEL gl SOURCES
    gl/coverage_test.cpp gl/plan_drawing_test.cpp gl/bent_frames.cpp gl/bent_frames.h gl/mesh_count.cpp gl/mesh_count.h
  LINK pixelflex_plan pixelflex_reference PkgConfig::EPOXY)
pixelflex_test(renderer_damage_test LABEL gl SOURCES gl/damage_test.cpp LINK pixelflex_renderer pixelflex_reference)
pixelflex_test(renderer_upload_test LABEL gl SOURCES gl/upload_path_test.cpp LINK pixelflex_renderer pixelflex_reference)
pixelflex_test(renderer_overlay_test LABEL gl SOURCES gl/overlay_test.cpp LINK pixelflex_renderer pixelflex_reference)
pixelflex_test(renderer_light_test LABEL gl SOURCES gl/light_test.cpp gl/dither_test.cpp
  LINK pixelflex_renderer pixelflex_reference)
pixelflex_test(plan_light_test LABEL unit SOURCES unit/plan_light_test.cpp support/temporary_folder.cpp
  LINK pixelflex_plan pixelflex_image)
pixelflex_test(plan_fit_test LABEL gl SOURCES gl/plan_fit_test.cpp unit/plan_fit_test.cpp gl/bent_frames.cpp gl/bent_frames.h
  LINK pixelflex_plan pixelflex_reference)
pixelflex_test(display_handle_test LABEL unit SOURCES unit/display_handle_test.cpp LINK pixelflex_display)
pixelflex_test(display_image_near_test LABEL unit SOURCES unit/display_image_near_test.cpp LINK pixelflex_image)
pixelflex_test(display_context_test LABEL gl SOURCES gl/context_test.cpp LINK pixelflex_display PkgConfig::EPOXY)
find_package(X11 REQUIRED)
pixelflex_test(display_window_test LABEL e2e SOURCES gl/window_test.cpp gl/x_server.cpp
  LINK pixelflex_display PkgConfig::EPOXY X11::X11)
pixelflex_test(renderer_room_view_test LABEL gl SOURCES gl/room_view_test.cpp LINK pixelflex_renderer PkgConfig::EPOXY)
pkg_check_modules(XCB_SAVER REQUIRED IMPORTED_TARGET xcb xcb-screensaver)
pixelflex_test(display_clipboard_test LABEL e2e SOURCES gl/clipboard_test.cpp gl/x_server.cpp support/temporary_folder.cpp
  LINK pixelflex_display X11::X11 PkgConfig::XCB_SAVER)
