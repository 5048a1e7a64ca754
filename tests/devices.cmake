# Lines to devices, drivers and the simulators of devices.
pixelflex_library(pixelflex_device_support
  HEADERS support_devices/bridges.h support_devices/scripted_server.h
  SOURCES support_devices/bridges.cpp support_devices/scripted_server.cpp
  PUBLIC pixelflex_test_support
  PRIVATE Threads::Threads)

pixelflex_test(transport_test LABEL unit
  SOURCES unit/transport_address_test.cpp unit/transport_line_test.cpp
  LINK pixelflex_device_support pixelflex_transport)

pixelflex_test(pan_tilt_test LABEL unit
  SOURCES unit/pan_tilt_reply_test.cpp unit/pan_tilt_simulator_test.cpp unit/pan_tilt_unit_test.cpp
  LINK pixelflex_device_host pixelflex_pan_tilt)

pixelflex_test(projector_control_test LABEL unit
  SOURCES unit/device_garbage_test.cpp unit/projector_drivers_test.cpp unit/projector_faults_test.cpp unit/projector_vectors_test.cpp support_devices/projector_bench.h
  LINK pixelflex_device_host pixelflex_projector_control pixelflex_device_support)

# Through programs of others, and as users type it.
pixelflex_test(device_ladder_test LABEL e2e
  SOURCES e2e/device_ladder_test.cpp
  LINK pixelflex_device_support pixelflex_device_host pixelflex_projector_control)

pixelflex_test(device_cli_test LABEL e2e
  SOURCES e2e/device_cli_test.cpp e2e/device_room.h
  LINK pixelflex_device_support pixelflex_device_host pixelflex_store)
add_dependencies(device_cli_test pixelflex-device pixelflex-simulate pixelflex-check)

pixelflex_test(wall_control_test LABEL unit
  SOURCES unit/preset_plan_test.cpp
  LINK pixelflex_wall_control)

pixelflex_test(wall_console_test LABEL unit
  SOURCES unit/wall_console_test.cpp e2e/device_room.h
  LINK pixelflex_wall_control pixelflex_device_support pixelflex_device_host)

pixelflex_test(preset_cli_test LABEL e2e
  SOURCES e2e/preset_cli_test.cpp e2e/device_room.h
  LINK pixelflex_device_support pixelflex_device_host pixelflex_store)
add_dependencies(preset_cli_test pixelflex-device pixelflex-preset pixelflex-check)

# Photographs over GigE Vision, between programs of others and of this house.
pixelflex_test(gige_camera_test LABEL unit
  SOURCES unit/gige_camera_test.cpp support_devices/gige_place.h
  LINK pixelflex_gige_camera pixelflex_cameras pixelflex_test_support)

# The whole room: devices, projectors and the camera, every one by its own protocol.
pixelflex_test(served_room_test LABEL e2e TIMEOUT 600
  SOURCES e2e/served_room_test.cpp support_calibration/registration.cpp support_calibration/registration.h support_devices/gige_place.h
  LINK pixelflex_test_support pixelflex_simulate pixelflex_store pixelflex_geometry)
add_dependencies(served_room_test pixelflex-new pixelflex-calibrate pixelflex-camera pixelflex-device pixelflex-preset pixelflex-simulate)

pixelflex_test(camera_test LABEL unit
  SOURCES unit/v4l2_camera_test.cpp unit/still_camera_test.cpp unit/raw_picture_test.cpp support_devices/fake_video.h support_image/jpeg.cpp support_image/jpeg.h
  LINK pixelflex_cameras JPEG::JPEG)
