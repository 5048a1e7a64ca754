# Registration against ground truth through the real renderer.
target_sources(pixelflex_test_calibration
  PRIVATE support_calibration/coordinate_desktop.cpp support_calibration/light_session.cpp
    support_calibration/response_error.cpp
  PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}
    FILES support_calibration/coordinate_desktop.h support_calibration/light_session.h
    support_calibration/response_error.h)
target_link_libraries(pixelflex_test_calibration PUBLIC pixelflex_plan PRIVATE pixelflex_renderer)

add_executable(accuracy_table accuracy/accuracy_table.cpp accuracy/accuracy_rigs.cpp accuracy/report_pipeline.cpp)
target_link_libraries(accuracy_table PRIVATE pixelflex_options pixelflex_test_calibration pixelflex_test_support
  CGAL::CGAL CLI11::CLI11 fmt::fmt opencv_core opencv_imgproc opencv_calib3d)
target_include_directories(accuracy_table SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
set_target_properties(accuracy_table PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
# What a pair must hold and what an inset must at least survive; by hand: accuracy_table --seeds 5.
add_test(NAME accuracy_pair COMMAND accuracy_table --strict --rigs pair)
add_test(NAME accuracy_inset COMMAND accuracy_table --rigs inset)
set_tests_properties(accuracy_pair accuracy_inset PROPERTIES LABELS "accuracy;gl" TIMEOUT 300 ENVIRONMENT "LIBGL_ALWAYS_SOFTWARE=1")

# Light of the wall, photographed again by the audience.
pixelflex_library(pixelflex_test_light
  HEADERS accuracy/light_figures.h accuracy/light_measurement.h accuracy/light_measures.h accuracy/light_rigs.h
    accuracy/report_light.h accuracy/seen_wall.h accuracy/shown_wall.h accuracy/text_likeness.h accuracy/wall_view.h
  SOURCES accuracy/light_figures.cpp accuracy/light_measurement.cpp accuracy/light_measures.cpp accuracy/light_rigs.cpp
    accuracy/report_light.cpp accuracy/seen_wall.cpp accuracy/shown_wall.cpp accuracy/text_likeness.cpp accuracy/wall_view.cpp gl/plans.cpp
  PUBLIC pixelflex_test_calibration pixelflex_test_support pixelflex_plan pixelflex_renderer
  PRIVATE pixelflex_photometric fmt::fmt)
target_compile_definitions(pixelflex_test_light PRIVATE PIXELFLEX_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
add_executable(light_table accuracy/light_table.cpp)
target_link_libraries(light_table PRIVATE pixelflex_options pixelflex_test_light CLI11::CLI11 fmt::fmt)
set_target_properties(light_table PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
pixelflex_test(light_match_test LABEL gl TIMEOUT 300 SOURCES accuracy/light_test.cpp LINK pixelflex_test_light)
pixelflex_test(light_measures_test LABEL unit
  SOURCES accuracy/light_measures_test.cpp accuracy/light_table_test.cpp LINK pixelflex_test_light)

# Responses measured by the camera.
pixelflex_test(response_accuracy_test LABEL unit TIMEOUT 240 SOURCES accuracy/response_test.cpp
  LINK pixelflex_test_calibration pixelflex_test_support)

# The largest rectangle against brute force.
pixelflex_test(display_optimum_test LABEL unit SOURCES accuracy/display_optimum_test.cpp LINK pixelflex_geometry)

# OpenCV's own photographs, of Debian's package opencv-doc, wherever that is installed.
set(PIXELFLEX_OPENCV_PHOTOS /usr/share/doc/opencv-doc/examples/data CACHE PATH "left01.jpg ... of OpenCV's samples")
if(EXISTS ${PIXELFLEX_OPENCV_PHOTOS}/left01.jpg)
  pixelflex_test(opencv_photos_test LABEL unit SOURCES accuracy/opencv_photos_test.cpp
    LINK pixelflex_estimate pixelflex_image opencv_core opencv_imgproc opencv_calib3d)
  target_include_directories(opencv_photos_test SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
  target_compile_definitions(opencv_photos_test PRIVATE PIXELFLEX_OPENCV_PHOTOS="${PIXELFLEX_OPENCV_PHOTOS}")
endif()

pixelflex_test(rig_layouts_test LABEL unit SOURCES accuracy/rig_layouts_test.cpp LINK pixelflex_simulate)
pixelflex_test(measured_light_test LABEL unit SOURCES accuracy/measured_light_test.cpp LINK pixelflex_test_calibration pixelflex_test_support)
