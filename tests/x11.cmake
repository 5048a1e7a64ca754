# The desktop of an X server of the same machine, against real X servers.
pixelflex_test(x11_source_test LABEL e2e-threads TIMEOUT 120
  SOURCES e2e/x11_input_test.cpp e2e/x11_screen_test.cpp
  LINK pixelflex_test_support pixelflex_x11source)

pixelflex_test(x11_view_test LABEL e2e TIMEOUT 180
  SOURCES e2e/x11_view_test.cpp
  LINK pixelflex_test_support pixelflex_x11source)
add_dependencies(x11_view_test pixelflex-new pixelflex-view)
