# SPDX-License-Identifier: Apache-2.0
# Translates IDL files: cmake -DFASTDDSGEN= -DROOT= "-DFILES=a.idl;b.idl" -DROS2= -DSCRATCH= -DOUT= -P AditIdlGenerate.cmake
# fastddsgen writes all its output into one folder: it gets a scratch folder, and two files of each IDL file are copied to
# their place from there.
file(REMOVE_RECURSE ${SCRATCH})
file(MAKE_DIRECTORY ${SCRATCH})
# The same -I twice makes it spin for ever. Without -t it preprocesses in /tmp, where two builds meet.
set(options -replace -cs -I ${ROOT} -d ${SCRATCH} -t ${SCRATCH})
if(ROS2)
  list(APPEND options -typeros2)
endif()
list(TRANSFORM FILES PREPEND ${ROOT}/ OUTPUT_VARIABLE paths)
# It runs for seconds: these options halve its processor time, which goes into Java's compiler.
set(ENV{JAVA_TOOL_OPTIONS} "-XX:TieredStopAtLevel=1 -XX:+UseSerialGC $ENV{JAVA_TOOL_OPTIONS}")
execute_process(COMMAND ${FASTDDSGEN} ${options} ${paths}
  TIMEOUT 300 RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
foreach(file ${FILES})
  string(REGEX REPLACE "\\.idl$" "" stem ${file})
  get_filename_component(base ${stem} NAME)
  if(NOT result EQUAL 0 OR NOT EXISTS ${SCRATCH}/${base}.cxx)
    message(FATAL_ERROR "fastddsgen ${file} failed (${result}):\n${output}")
  endif()
  foreach(extension h cxx)
    file(READ ${SCRATCH}/${base}.${extension} text)
    # Addresses of Java objects in comments differ at each run; without them ccache knows the file again.
    string(REGEX REPLACE "TypeCode@[0-9a-f]+" "TypeCode" text "${text}")
    set(old "")
    if(EXISTS ${OUT}/${stem}.${extension})
      file(READ ${OUT}/${stem}.${extension} old)
    endif()
    if(NOT old STREQUAL text)
      file(WRITE ${OUT}/${stem}.${extension} "${text}")
    endif()
  endforeach()
endforeach()
file(REMOVE_RECURSE ${SCRATCH})
