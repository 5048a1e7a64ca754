add_library(pixelflex_reference STATIC ${CMAKE_CURRENT_SOURCE_DIR}/reference/reference_warp.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/gl/plans.cpp)
target_link_libraries(pixelflex_reference PRIVATE pixelflex_options PUBLIC pixelflex_tiles pixelflex_renderer)

pixelflex_test(renderer_exact_test LABEL gl SOURCES gl/exact_test.cpp LINK pixelflex_renderer pixelflex_reference)
