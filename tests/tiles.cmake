pixelflex_test(tiles_test LABEL unit
  SOURCES unit/tiles_belt_test.cpp unit/tiles_layout_test.cpp unit/tiles_region_test.cpp unit/tiles_stages_test.cpp
  LINK pixelflex_tiles)
