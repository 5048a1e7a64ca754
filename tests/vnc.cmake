# Servers, X clients and screenshots for every test that needs a real desktop.
pkg_check_modules(X11 REQUIRED IMPORTED_TARGET x11)
pixelflex_library(pixelflex_test_support
  HEADERS support/certificates.h support/cut_relay.h support/desktop_mirror.h support/fake_vnc_server.h support/free_port.h support/process.h support/slow_relay.h support/temporary_folder.h support/x_servers.h
  SOURCES support/certificates.cpp support/cut_relay.cpp support/desktop_mirror.cpp support/fake_vnc_server.cpp support/free_port.cpp support/process.cpp support/slow_relay.cpp support/temporary_folder.cpp
    support/x_grab.cpp support/x_servers.cpp
  PUBLIC pixelflex_image pixelflex_vnc
  PRIVATE PkgConfig::X11)

# e2e-threads: those that ThreadSanitizer runs as well.
pixelflex_test(vnc_e2e_test LABEL e2e-threads TIMEOUT 120
  SOURCES e2e/vnc_cut_test.cpp e2e/vnc_link_test.cpp e2e/vnc_reconnect_test.cpp e2e/vnc_security_test.cpp e2e/vnc_xvnc_test.cpp
  LINK pixelflex_test_support)

add_library(vnc_entry STATIC fuzz/vnc_entry.cpp)
target_link_libraries(vnc_entry PRIVATE pixelflex_options PUBLIC pixelflex_vnc)

pixelflex_test(vnc_test LABEL unit TIMEOUT 120
  SOURCES unit/vnc_address_test.cpp unit/vnc_clipboard_test.cpp unit/vnc_corpus_test.cpp unit/vnc_failure_test.cpp unit/vnc_hostile_cases_test.cpp
    unit/vnc_hostile_test.cpp unit/vnc_jpeg_test.cpp unit/vnc_link_test.cpp unit/vnc_pieces_test.cpp unit/vnc_plain_login_test.cpp unit/vnc_reconnect_test.cpp unit/vnc_resize_test.cpp unit/vnc_security_test.cpp unit/vnc_secret_test.cpp unit/vnc_session_test.cpp support/memory_search.cpp support/memory_search.h support/tls_server.cpp support/tls_server.h support_image/jpeg.cpp support_image/jpeg.h
  LINK pixelflex_test_support vnc_entry PkgConfig::GNUTLS JPEG::JPEG ZLIB::ZLIB)

# What a server may say, by clang++ (preset fuzz): ./vnc_fuzz CORPUS -max_total_time=60
if(PIXELFLEX_FUZZ)
  add_executable(vnc_fuzz fuzz/vnc_fuzz.cpp)
  target_link_libraries(vnc_fuzz PRIVATE pixelflex_options vnc_entry -fsanitize=fuzzer)
  add_dependencies(fuzzers vnc_fuzz)
endif()
