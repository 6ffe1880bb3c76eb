# SPDX-License-Identifier: Apache-2.0
# One way to declare each kind of target. Includes are written from the root of the source tree:
#   #include "core/exec/executor.hpp"

# The headers that most libraries parse, parsed once for all of them: a third of the time of a build.
function(adit_library_headers target)
  if(NOT TARGET adit_library_pch)
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/library_pch.cpp CONTENT "\n")
    add_library(adit_library_pch STATIC ${PROJECT_BINARY_DIR}/library_pch.cpp)
    set_target_properties(adit_library_pch PROPERTIES UNITY_BUILD OFF)
    target_link_libraries(adit_library_pch PRIVATE Eigen3::Eigen Threads::Threads)
    target_precompile_headers(adit_library_pch PRIVATE
      <Eigen/Dense> <algorithm> <array> <atomic> <chrono> <cmath> <condition_variable> <deque> <filesystem>
      <fstream> <functional> <iostream> <map> <memory> <mutex> <optional> <random> <set> <span> <sstream> <string>
      <thread> <unordered_map> <variant> <vector>)
  endif()
  target_precompile_headers(${target} REUSE_FROM adit_library_pch)
  # A library whose dependencies set a flag that the headers were not compiled with parses them again, quietly.
  set_target_properties(${target} PROPERTIES PCH_WARN_INVALID OFF)
endfunction()

# Compiles the sources of a target SIZE at a time, where the preset asks for it (CMAKE_UNITY_BUILD). CMake's own files for that
# include each source by its absolute path, so ccache has to preprocess every one again in another clone; these include it by
# its path in the source tree, and are the same everywhere. Sources that have compiler options of their own stay alone, and so
# do generated ones: without them among the target's sources, nothing would generate them.
function(adit_batch target size)
  if(NOT CMAKE_UNITY_BUILD)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
  get_target_property(sources ${target} SOURCES)
  set(batches "")
  set(count 0)
  foreach(source ${sources})
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    get_source_file_property(definitions ${source} COMPILE_DEFINITIONS)
    get_source_file_property(generated ${source} GENERATED)
    get_filename_component(path ${source} ABSOLUTE)
    file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${path})
    if(NOT path MATCHES "\\.cpp$" OR options OR definitions OR generated)
      list(APPEND batches ${source})
      continue()
    endif()
    math(EXPR batch "${count} / ${size}")
    math(EXPR count "${count} + 1")
    string(APPEND content_${batch} "#include \"${path}\"\n")
  endforeach()
  if(count LESS 2)
    return()
  endif()
  foreach(number RANGE ${batch})
    set(file ${CMAKE_CURRENT_BINARY_DIR}/batches/${target}_${number}.cpp)
    file(CONFIGURE OUTPUT ${file} CONTENT "${content_${number}}" @ONLY)
    list(APPEND batches ${file})
  endforeach()
  set_target_properties(${target} PROPERTIES SOURCES "${batches}")
endfunction()

# adit_library(NAME SOURCES a.cpp ... [PUBLIC dep ...] [PRIVATE dep ...])
# A static library target adit_NAME (alias adit::NAME), installed and exported.
function(adit_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(adit_${name} STATIC ${arg_SOURCES})
  add_library(adit::${name} ALIAS adit_${name})
  set_target_properties(adit_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(adit_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/adit>)
  target_link_libraries(adit_${name} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  target_compile_features(adit_${name} PUBLIC cxx_std_20)
  adit_library_headers(adit_${name})
  adit_batch(adit_${name} 8)
  install(TARGETS adit_${name} EXPORT adit-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()

# For libraries whose loops run for each return of a scan or each cell of a map. None asks for errno or a trap; without
# them GCC takes four numbers at once. -O3: 4 % less processor time of a rehearsal, the same digests; they take 0 to 13 %
# longer to compile. Sanitizers have a level of their own.
function(adit_numeric name)
  target_compile_options(adit_${name} PRIVATE -fno-math-errno -fno-trapping-math)
  if(NOT ADIT_SANITIZE)
    target_compile_options(adit_${name} PRIVATE $<$<CONFIG:Release>:-O3>)
  endif()
endfunction()

# adit_program(NAME SOURCES ... LINK dep ...): an executable that is installed under its name.
function(adit_program name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LINK})
  adit_batch(${name} 8)
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()

# The headers that nearly every test parses, parsed once for all tests of one optimisation level. Tests are compiled without
# optimisation: the libraries under test are optimised, and a test takes a quarter less time to compile. Tests of folders that
# compute much themselves stay optimised; sanitizers have a level of their own.
function(adit_test_headers target optimised)
  set(pch adit_test_pch)
  set(level -O0)
  if(optimised OR ADIT_SANITIZE)
    set(level "")
    string(APPEND pch _optimised)
  endif()
  if(NOT TARGET ${pch})
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/test_pch.cpp CONTENT "int main() { return 0; }\n")
    # A program, as the tests are: the header must be compiled with the same -fPIE.
    add_executable(${pch} ${PROJECT_BINARY_DIR}/test_pch.cpp)
    set_target_properties(${pch} PROPERTIES UNITY_BUILD OFF RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
    target_link_libraries(${pch} PRIVATE GTest::gmock Eigen3::Eigen Threads::Threads)
    target_compile_options(${pch} PRIVATE ${level})
    target_precompile_headers(${pch} PRIVATE
      <gmock/gmock.h> <gtest/gtest.h> <chrono> <filesystem> <fstream> <functional> <memory> <string> <thread> <vector>)
  endif()
  target_compile_options(${target} PRIVATE ${level})
  target_precompile_headers(${target} REUSE_FROM ${pch})
  # A test whose other libraries set a flag that the header was not compiled with parses it again, quietly.
  set_target_properties(${target} PROPERTIES PCH_WARN_INVALID OFF)
endfunction()

# adit_test(NAME SOURCES ... LINK dep ... [LABELS label ...] [TIMEOUT seconds] [SERIAL] [FIXTURE name])
# A GoogleTest program test_NAME; each of its cases is one ctest. Target adit_tests builds all of them but those that only
# `./run test long` runs, which target adit_long_tests builds: each of those programs is one ctest.
# Labels: unit (default, milliseconds), rehearsal, live (processes over Fast DDS), slow, long (soaks, fuzzing, campaigns
# and benchmarks: run by `./run test long` alone).
# Each case of a live test has a network and folders of its own (tests/live/isolated.sh), so all run side by side. They
# run once more with the limits of an idle machine, label long, as NAME.InTime.
# SERIAL: its cases never run beside other tests. FIXTURE: the ctest fixture that they need.
# Under sanitizers only some are built: address takes those labelled unit of the folders that read foreign bytes, store, or
# have states (with ADIT_SANITIZE_ALL, of all folders: ./run test long); thread takes those in tests/client, tests/core,
# tests/wire (live ones over Fast DDS too) and tests/live. NO_SANITIZE leaves one out, with the reason beside it.
option(ADIT_SANITIZE_ALL "Under the address sanitizer, build the unit tests of all folders")
function(adit_test name)
  if(NOT ADIT_TESTS)
    return()
  endif()
  cmake_parse_arguments(arg "SERIAL;NO_SANITIZE" "TIMEOUT;FIXTURE" "SOURCES;LINK;LABELS" ${ARGN})
  if(NOT arg_LABELS)
    set(arg_LABELS unit)
  endif()
  get_filename_component(part ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  if(ADIT_SANITIZE AND arg_NO_SANITIZE)
    return()
  elseif(ADIT_SANITIZE MATCHES address AND NOT "unit" IN_LIST arg_LABELS)
    return()
  elseif(ADIT_SANITIZE MATCHES address AND NOT ADIT_SANITIZE_ALL AND NOT part MATCHES
         "^(agent|bt|client|cloud|command|contract|core|findings|gui|live|perception|record|station|store|transfer|wire)$")
    return()
  elseif(ADIT_SANITIZE STREQUAL thread AND NOT part MATCHES "^(client|core|wire|live)$")
    return()
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 60)
    if("live" IN_LIST arg_LABELS)
      set(arg_TIMEOUT 600)
    endif()
  endif()
  add_executable(test_${name} ${arg_SOURCES})
  if("live" IN_LIST arg_LABELS)
    # CMake runs a test program through this wrapper.
    set_target_properties(test_${name} PROPERTIES CROSSCOMPILING_EMULATOR ${PROJECT_SOURCE_DIR}/tests/live/isolated.sh)
    add_test(NAME ${name}.InTime COMMAND test_${name})
    set_tests_properties(${name}.InTime PROPERTIES LABELS long TIMEOUT 3600 RUN_SERIAL TRUE ENVIRONMENT ADIT_PATIENCE=1
      FIXTURES_REQUIRED "${arg_FIXTURE}")
  endif()
  target_link_libraries(test_${name} PRIVATE ${arg_LINK} adit_folders GTest::gmock GTest::gtest_main)
  # These folders' tests generate and search clouds and maps.
  set(optimised FALSE)
  if(part MATCHES "^(nav|navtool|sim)$")
    set(optimised TRUE)
  endif()
  adit_test_headers(test_${name} ${optimised})
  # Parsing of headers is most of what a test takes to compile: more files share it than those of libraries.
  adit_batch(test_${name} 16)
  if("long" IN_LIST arg_LABELS)
    add_dependencies(adit_long_tests test_${name})
    add_test(NAME ${name} COMMAND test_${name})
    set_tests_properties(${name} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT} RUN_SERIAL TRUE)
    return()
  endif()
  add_dependencies(adit_tests test_${name})
  set(serial "")
  if(arg_SERIAL)
    set(serial RUN_SERIAL TRUE)
  endif()
  set(fixture "")
  if(arg_FIXTURE)
    set(fixture FIXTURES_REQUIRED ${arg_FIXTURE})
  endif()
  # ctest starts expensive tests first, so that none is left to run alone at the end.
  set(cost "")
  if("rehearsal" IN_LIST arg_LABELS)
    set(cost COST 20)
  endif()
  gtest_discover_tests(test_${name} TEST_PREFIX ${name}. DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT} ${serial} ${cost} ${fixture})
endfunction()

# adit_bench(NAME SOURCES ... LINK dep ...): a Google Benchmark program bench_NAME.
function(adit_bench name)
  if(NOT ADIT_BENCH)
    return()
  endif()
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  find_package(benchmark REQUIRED)
  add_executable(bench_${name} ${arg_SOURCES})
  target_link_libraries(bench_${name} PRIVATE ${arg_LINK} adit_folders benchmark::benchmark)
endfunction()
