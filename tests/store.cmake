pixelflex_test(store_test LABEL unit
  SOURCES unit/store_wall_test.cpp unit/store_calibration_test.cpp
  LINK pixelflex_store pixelflex_image)
