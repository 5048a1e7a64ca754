add_library(store_entry STATIC fuzz/store_entry.cpp)
target_link_libraries(store_entry PRIVATE pixelflex_options PUBLIC pixelflex_store)

pixelflex_test(store_test LABEL unit TIMEOUT 240
  SOURCES unit/store_devices_test.cpp unit/store_wall_test.cpp unit/store_calibration_test.cpp unit/store_yaml_test.cpp unit/store_save_test.cpp
    unit/store_check_test.cpp unit/store_mutation_test.cpp support/temporary_folder.cpp
  LINK pixelflex_store pixelflex_image store_entry)

pixelflex_test(image_test LABEL unit
  SOURCES unit/image_png_test.cpp unit/image_photo_test.cpp unit/image_atomic_test.cpp support/temporary_folder.cpp support_image/jpeg.cpp support_image/jpeg.h
  LINK pixelflex_image PNG::PNG JPEG::JPEG ZLIB::ZLIB)

# A fuzzer for the readers of the store, by clang++ (preset fuzz): ./store_fuzz CORPUS -max_total_time=60
if(PIXELFLEX_FUZZ)
  add_executable(store_fuzz fuzz/store_fuzz.cpp)
  target_link_libraries(store_fuzz PRIVATE pixelflex_options store_entry -fsanitize=fuzzer)
  add_custom_target(fuzzers DEPENDS store_fuzz)
endif()
