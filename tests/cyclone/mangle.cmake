# SPDX-License-Identifier: Apache-2.0
# Writes all of our ROS 2 IDL into one file under the names that ROS 2's own tools give its types on the wire
# (pkg::msg::dds_::Type_), for another vendor's compiler: cmake -DROOT=idl/ros2 -DFILES=a;b -DOUT=file.idl -P mangle.cmake
# FILES in the order of their dependence.
set(out "")
foreach(file ${FILES})
  file(READ ${ROOT}/${file}.idl text)
  string(REGEX REPLACE "#(include|ifndef|define|endif)[^\n]*\n" "" text "${text}")
  string(REGEX REPLACE "([a-z_]+::msg::)([A-Za-z0-9]+)" "\\1dds_::\\2_" text "${text}")
  string(REGEX REPLACE "struct ([A-Za-z0-9]+)" "struct \\1_" text "${text}")
  string(REPLACE "module msg {" "module msg { module dds_ {" text "${text}")
  string(REGEX REPLACE "};[ \n]*}[;][ \n]*$" "}; }; };\n" text "${text}")
  string(APPEND out "${text}")
endforeach()
file(WRITE ${OUT} "${out}")
