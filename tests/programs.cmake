# The programs as users run them, on simulated walls and against real VNC servers.
pixelflex_test(calibrate_cli_test LABEL e2e TIMEOUT 240
  SOURCES e2e/calibrate_cli_test.cpp e2e/calibrate_photos_test.cpp e2e/calibrate_layout_test.cpp e2e/calibrate_repair_test.cpp
  LINK pixelflex_test_support pixelflex_simulate pixelflex_store)
add_dependencies(calibrate_cli_test pixelflex-new pixelflex-calibrate)

pixelflex_test(calibrate_response_test LABEL e2e TIMEOUT 300
  SOURCES e2e/calibrate_response_test.cpp
  LINK pixelflex_test_support pixelflex_simulate pixelflex_patterns pixelflex_store)
add_dependencies(calibrate_response_test pixelflex-new pixelflex-calibrate)

pixelflex_test(calibrate_bad_photos_test LABEL e2e TIMEOUT 240
  SOURCES e2e/calibrate_bad_photos_test.cpp
  LINK pixelflex_test_support pixelflex_simulate pixelflex_store)
add_dependencies(calibrate_bad_photos_test pixelflex-new pixelflex-calibrate)

pixelflex_test(calibrate_curved_test LABEL e2e TIMEOUT 300
  SOURCES e2e/calibrate_curved_test.cpp
  LINK pixelflex_test_support pixelflex_simulate pixelflex_store pixelflex_geometry)
add_dependencies(calibrate_curved_test pixelflex-new pixelflex-calibrate)

pixelflex_test(view_cli_test LABEL e2e TIMEOUT 240
  SOURCES e2e/view_exact_test.cpp e2e/view_errors_test.cpp e2e/view_idle_test.cpp e2e/view_input_test.cpp
    e2e/view_depth_test.cpp e2e/view_resize_test.cpp e2e/view_lost_test.cpp e2e/view_quit_test.cpp e2e/view_security_test.cpp
    e2e/view_stats_test.cpp
  LINK pixelflex_test_support pixelflex_store)
add_dependencies(view_cli_test pixelflex-new pixelflex-calibrate pixelflex-view)

pixelflex_test(desktop_test LABEL e2e TIMEOUT 240
  SOURCES e2e/desktop_test.cpp
  LINK pixelflex_test_support)
add_dependencies(desktop_test pixelflex-new pixelflex-desktop pixelflex-view)

pixelflex_test(view_pointer_test LABEL unit
  SOURCES unit/view_pointer_test.cpp ${PROJECT_SOURCE_DIR}/viewer/programs/control_taps.cpp
    ${PROJECT_SOURCE_DIR}/viewer/programs/pointer_shake.cpp)

# Windows on one X server, the desktop on another.
pixelflex_test(view_desk_test LABEL e2e TIMEOUT 240
  SOURCES e2e/view_clipboard_test.cpp e2e/view_desk_test.cpp e2e/view_desk_keys.h e2e/view_everyday_test.cpp e2e/view_gestures_test.cpp e2e/view_outputs_test.cpp e2e/view_screens.h support/paint_client.cpp support/paint_client.h
    support/x_desk.cpp support/x_desk.h support/x_shortcut.cpp support/x_shortcut.h
  LINK pixelflex_test_support pixelflex_store X11::X11)
add_dependencies(view_desk_test pixelflex-new pixelflex-view)
