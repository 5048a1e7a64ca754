# Remote controls of a wall, against simulated devices.
pixelflex_test(remote_http_test LABEL unit
  SOURCES unit/remote_http_test.cpp unit/remote_room.h e2e/device_room.h support/tcp_talk.cpp support/tcp_talk.h
  LINK pixelflex_remote pixelflex_device_support pixelflex_device_host nlohmann_json::nlohmann_json)

pixelflex_test(remote_pjlink_test LABEL unit
  SOURCES unit/remote_pjlink_test.cpp unit/remote_room.h e2e/device_room.h support/tcp_talk.cpp support/tcp_talk.h support/udp_talk.cpp support/udp_talk.h
  LINK pixelflex_remote pixelflex_device_support pixelflex_device_host pixelflex_projector_control nlohmann_json::nlohmann_json)
