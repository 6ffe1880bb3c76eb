# SPDX-License-Identifier: Apache-2.0
# A folder of IDL becomes a library of plain types with their CDR serialisation (Fast CDR alone, no
# Fast DDS at run time). Nothing generated is kept in the source tree. All files of a library are translated
# together, as most of the time of a fastddsgen run is the start of its Java machine; generated files that come
# out the same are not written again, so that only what changed is compiled.

find_package(fastcdr REQUIRED)
find_program(ADIT_FASTDDSGEN fastddsgen REQUIRED)

# adit_idl(NAME ROOT folder FOLDERS sub ... [ROS2])
# Library adit_NAME (alias adit::NAME) of all *.idl in the named folders below ROOT. Headers are included
# by their path from ROOT: ROOT/adit/command.idl gives "adit/command.h". ROS2: type names as ROS 2 mangles
# them. Headers and IDL are installed.
function(adit_idl name)
  cmake_parse_arguments(arg "ROS2" "ROOT" "FOLDERS" ${ARGN})
  get_filename_component(root ${arg_ROOT} ABSOLUTE)
  set(generated ${PROJECT_BINARY_DIR}/idl/${name})
  set(files)
  set(sources)
  set(names)
  foreach(folder ${arg_FOLDERS})
    file(GLOB in_folder CONFIGURE_DEPENDS RELATIVE ${root} ${root}/${folder}/*.idl)
    list(APPEND files ${in_folder})
  endforeach()
  foreach(file ${files})
    string(REGEX REPLACE "\\.idl$" "" stem ${file})
    list(APPEND sources ${generated}/include/${stem}.h ${generated}/include/${stem}.cxx)
    get_filename_component(base ${stem} NAME)
    if(base IN_LIST names)
      message(FATAL_ERROR "${file}: fastddsgen writes all files into one folder, and has a ${base}.idl already")
    endif()
    list(APPEND names ${base})
    get_filename_component(path ${stem} DIRECTORY)
    install(FILES ${generated}/include/${stem}.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/adit/idl/${path})
    install(FILES ${root}/${file} DESTINATION ${CMAKE_INSTALL_DATADIR}/adit/idl/${path})
  endforeach()
  list(TRANSFORM files PREPEND ${root}/ OUTPUT_VARIABLE paths)
  set(script ${PROJECT_SOURCE_DIR}/cmake/AditIdlGenerate.cmake)
  add_custom_command(
    OUTPUT ${sources}
    COMMAND ${CMAKE_COMMAND} -DFASTDDSGEN=${ADIT_FASTDDSGEN} -DROOT=${root} "-DFILES=${files}" -DROS2=${arg_ROS2}
            -DSCRATCH=${generated}/scratch -DOUT=${generated}/include -P ${script}
    DEPENDS ${paths} ${script}
    COMMENT "IDL of ${name}" VERBATIM)

  add_library(adit_${name} STATIC ${sources})
  add_library(adit::${name} ALIAS adit_${name})
  set_target_properties(adit_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_options(adit_${name} PRIVATE -w)  # not our code: our warnings do not apply
  target_include_directories(adit_${name} SYSTEM PUBLIC
    $<BUILD_INTERFACE:${generated}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/adit/idl>)
  target_link_libraries(adit_${name} PUBLIC fastcdr)
  install(TARGETS adit_${name} EXPORT adit-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()
