# What holds for the house as a whole: include arrows, formatting, shipped files, and the commands as users type them.
pixelflex_test(house_test LABEL unit TIMEOUT 300
  SOURCES unit/house_test.cpp support/process.cpp support/temporary_folder.cpp)

pixelflex_test(config_test LABEL unit
  SOURCES unit/house_config_test.cpp unit/store_new_test.cpp support/temporary_folder.cpp
  LINK pixelflex_new_wall pixelflex_simulate pixelflex_store)

pixelflex_test(cli_test LABEL e2e
  SOURCES e2e/cli_dispatch_test.cpp e2e/cli_new_check_test.cpp
  LINK pixelflex_store pixelflex_test_support)
add_dependencies(cli_test pixelflex pixelflex-new pixelflex-check)
