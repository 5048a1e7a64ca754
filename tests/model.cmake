# 3D models: files, drawing, accuracy on simulated walls, the program.
pixelflex_test(model_scene_test LABEL unit SOURCES unit/model_scene_test.cpp support/temporary_folder.cpp
  LINK pixelflex_scene)
pixelflex_test(model_depth_test LABEL gl SOURCES gl/model_depth_test.cpp LINK pixelflex_model)
pixelflex_test(model_wall_test LABEL gl TIMEOUT 300 SOURCES accuracy/model_wall_test.cpp
  LINK pixelflex_test_calibration pixelflex_test_support pixelflex_model_plan)
pixelflex_test(model_cli_test LABEL e2e TIMEOUT 240 SOURCES e2e/model_cli_test.cpp
  LINK pixelflex_test_support pixelflex_image)
add_dependencies(model_cli_test pixelflex-new pixelflex-model)
