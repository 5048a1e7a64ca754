# Remote controls of a wall, against simulated devices.
pixelflex_test(remote_http_test LABEL unit
  SOURCES unit/remote_http_test.cpp unit/remote_room.h e2e/device_room.h support/tcp_talk.cpp support/tcp_talk.h
  LINK pixelflex_remote pixelflex_device_support pixelflex_device_host nlohmann_json::nlohmann_json)

pixelflex_test(remote_pjlink_test LABEL unit
  SOURCES unit/remote_pjlink_test.cpp unit/remote_room.h e2e/device_room.h support/tcp_talk.cpp support/tcp_talk.h support/udp_talk.cpp support/udp_talk.h
  LINK pixelflex_remote pixelflex_device_support pixelflex_device_host pixelflex_projector_control nlohmann_json::nlohmann_json)

pixelflex_test(remote_server_test LABEL unit
  SOURCES unit/remote_server_test.cpp support/tcp_talk.cpp support/tcp_talk.h
  LINK pixelflex_remote pixelflex_transport)

# As users type it, and asked by curl.
pixelflex_test(serve_test LABEL e2e
  SOURCES e2e/serve_test.cpp e2e/device_room.h support/tcp_talk.cpp support/tcp_talk.h
  LINK pixelflex_device_support pixelflex_device_host pixelflex_store)
add_dependencies(serve_test pixelflex-serve)
