# A folder of IDL becomes a library of plain types with their CDR serialisation (Fast CDR alone, no
# Fast DDS at run time). Nothing generated is kept in the source tree; an IDL file is translated again
# only when it, or an IDL file it includes, has changed.

find_package(fastcdr REQUIRED)
find_program(ADIT_FASTDDSGEN fastddsgen REQUIRED)

# Every IDL file that `file` includes, itself included, transitively. Includes are looked up beside the
# including file, then from `root`.
function(_adit_idl_closure file root out)
  set(seen ${${out}})
  if(NOT file IN_LIST seen)
    list(APPEND seen ${file})
    # A changed #include changes what the commands depend on.
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    get_filename_component(folder ${file} DIRECTORY)
    file(STRINGS ${file} lines REGEX "^#include \"")
    foreach(line ${lines})
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" included "${line}")
      if(EXISTS ${folder}/${included})
        _adit_idl_closure(${folder}/${included} ${root} seen)
      elseif(EXISTS ${root}/${included})
        _adit_idl_closure(${root}/${included} ${root} seen)
      else()
        message(FATAL_ERROR "${file}: no IDL file ${included}")
      endif()
    endforeach()
  endif()
  set(${out} ${seen} PARENT_SCOPE)
endfunction()

# adit_idl(NAME ROOT folder FOLDERS sub ... [ROS2])
# Library adit_NAME (alias adit::NAME) of all *.idl in the named folders below ROOT. Headers are included
# by their path from ROOT: ROOT/adit/command.idl gives "adit/command.h". ROS2: type names as ROS 2 mangles
# them. Headers and IDL are installed.
function(adit_idl name)
  cmake_parse_arguments(arg "ROS2" "ROOT" "FOLDERS" ${ARGN})
  get_filename_component(root ${arg_ROOT} ABSOLUTE)
  set(generated ${PROJECT_BINARY_DIR}/idl/${name})
  set(sources)
  foreach(folder ${arg_FOLDERS})
    file(GLOB files CONFIGURE_DEPENDS RELATIVE ${root} ${root}/${folder}/*.idl)
    foreach(file ${files})
      string(REGEX REPLACE "\\.idl$" "" stem ${file})
      set(closure)
      _adit_idl_closure(${root}/${file} ${root} closure)
      set(outputs ${generated}/include/${stem}.h ${generated}/include/${stem}.cxx)
      add_custom_command(
        OUTPUT ${outputs}
        COMMAND ${CMAKE_COMMAND} -DFASTDDSGEN=${ADIT_FASTDDSGEN} -DROOT=${root} -DFILE=${file}
                -DROS2=${arg_ROS2} -DSCRATCH=${generated}/scratch/${stem} -DOUT=${generated}/include
                -P ${PROJECT_SOURCE_DIR}/cmake/AditIdlGenerate.cmake
        DEPENDS ${closure} ${PROJECT_SOURCE_DIR}/cmake/AditIdlGenerate.cmake
        COMMENT "IDL ${file}" VERBATIM)
      list(APPEND sources ${outputs})
      get_filename_component(path ${stem} DIRECTORY)
      install(FILES ${generated}/include/${stem}.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/adit/idl/${path})
      install(FILES ${root}/${file} DESTINATION ${CMAKE_INSTALL_DATADIR}/adit/idl/${path})
    endforeach()
  endforeach()

  add_library(adit_${name} STATIC ${sources})
  add_library(adit::${name} ALIAS adit_${name})
  set_target_properties(adit_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_options(adit_${name} PRIVATE -w)  # not our code: our warnings do not apply
  target_include_directories(adit_${name} SYSTEM PUBLIC
    $<BUILD_INTERFACE:${generated}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/adit/idl>)
  target_link_libraries(adit_${name} PUBLIC fastcdr)
  install(TARGETS adit_${name} EXPORT adit-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()
