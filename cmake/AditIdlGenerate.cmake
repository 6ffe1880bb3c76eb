# Translates one IDL file: cmake -DFASTDDSGEN= -DROOT= -DFILE= -DROS2= -DSCRATCH= -DOUT= -P AditIdlGenerate.cmake
# fastddsgen writes flat and writes everything that is included, too: it gets a scratch folder of its own
# and the two files of this IDL are copied to their place.
file(REMOVE_RECURSE ${SCRATCH})
file(MAKE_DIRECTORY ${SCRATCH})
# The same -I twice makes it spin for ever. Without -t it preprocesses in /tmp, where two builds meet.
set(options -replace -cs -I ${ROOT} -d ${SCRATCH} -t ${SCRATCH})
if(ROS2)
  list(APPEND options -typeros2)
endif()
execute_process(COMMAND ${FASTDDSGEN} ${options} ${ROOT}/${FILE}
  TIMEOUT 60 RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
string(REGEX REPLACE "\\.idl$" "" stem ${FILE})
get_filename_component(base ${stem} NAME)
if(NOT result EQUAL 0 OR NOT EXISTS ${SCRATCH}/${base}.cxx)
  message(FATAL_ERROR "fastddsgen ${FILE} failed (${result}):\n${output}")
endif()
foreach(extension h cxx)
  file(READ ${SCRATCH}/${base}.${extension} text)
  # Addresses of Java objects in comments differ at each run; without them ccache knows the file again.
  string(REGEX REPLACE "TypeCode@[0-9a-f]+" "TypeCode" text "${text}")
  file(WRITE ${OUT}/${stem}.${extension} "${text}")
endforeach()
file(REMOVE_RECURSE ${SCRATCH})
