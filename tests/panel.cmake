# The control panel.
pixelflex_test(mirror_aim_test LABEL unit
  SOURCES unit/mirror_aim_test.cpp
  LINK pixelflex_panel pixelflex_test_support)

pixelflex_test(panel_test LABEL e2e TIMEOUT 240
  SOURCES e2e/panel_test.cpp e2e/panel_window.h e2e/device_room.h
  LINK pixelflex_test_support pixelflex_device_host pixelflex_store)
add_dependencies(panel_test pixelflex-calibrate pixelflex-new pixelflex-panel)
