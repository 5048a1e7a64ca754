pixelflex_test(simulate_test LABEL unit
  SOURCES unit/simulate_optics_test.cpp unit/simulate_light_test.cpp unit/simulate_camera_test.cpp
    unit/simulate_rig_test.cpp unit/simulate_layouts_test.cpp unit/simulate_audience_test.cpp
    unit/simulate_screen_test.cpp unit/simulate_places_test.cpp
  LINK pixelflex_simulate pixelflex_store pixelflex_image)

# OpenCV as an outside witness: its marker dictionary and its detectors.
pixelflex_test(simulate_scene_test LABEL unit
  SOURCES unit/simulate_scene_test.cpp
  LINK pixelflex_simulate pixelflex_image opencv_core opencv_imgproc opencv_calib3d opencv_aruco)
target_include_directories(simulate_scene_test SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})

pixelflex_test(simulate_program_test LABEL unit
  SOURCES unit/simulate_program_test.cpp support/process.cpp support/temporary_folder.cpp
  LINK pixelflex_simulate pixelflex_store pixelflex_image)
add_dependencies(simulate_program_test pixelflex-simulate)
pixelflex_test(simulate_room_test LABEL unit
  SOURCES unit/simulate_room_test.cpp support/temporary_folder.cpp
  LINK pixelflex_simulate)
