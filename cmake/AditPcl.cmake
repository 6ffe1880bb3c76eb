# SPDX-License-Identifier: Apache-2.0
# The part of the Point Cloud Library that reads files. Its own configuration searches for VTK and Qt, and its -dev
# package pulls 1.2 GB of them in; reading needs the library and its headers, which ./run setup takes out of that package
# (data/pcl). Robots, stations and the demo never link it.
#   ADIT_PCL  ON when found, unless set; without it perctool is not built and navtool reads no .pcd and .ply
find_path(ADIT_PCL_INCLUDE pcl/io/pcd_io.h HINTS ${PROJECT_SOURCE_DIR}/data PATH_SUFFIXES pcl pcl-1.13)
find_library(ADIT_PCL_IO NAMES pcl_io libpcl_io.so.1.13)
find_library(ADIT_PCL_IO_PLY NAMES pcl_io_ply libpcl_io_ply.so.1.13)
find_library(ADIT_PCL_COMMON NAMES pcl_common libpcl_common.so.1.13)
find_path(ADIT_BOOST_INCLUDE boost/version.hpp)
mark_as_advanced(ADIT_PCL_INCLUDE ADIT_PCL_IO ADIT_PCL_IO_PLY ADIT_PCL_COMMON ADIT_BOOST_INCLUDE)
set(adit_pcl_found OFF)
if(ADIT_PCL_INCLUDE AND ADIT_PCL_IO AND ADIT_PCL_IO_PLY AND ADIT_PCL_COMMON AND ADIT_BOOST_INCLUDE)
  set(adit_pcl_found ON)
endif()
option(ADIT_PCL "Build perctool, and read .pcd and .ply with the Point Cloud Library" ${adit_pcl_found})
if(ADIT_PCL AND NOT adit_pcl_found)
  message(FATAL_ERROR "ADIT_PCL needs libpcl-io1.13, libboost-dev and data/pcl (./run setup)")
endif()
if(ADIT_PCL)
  add_library(adit_pcl INTERFACE)
  target_include_directories(adit_pcl SYSTEM INTERFACE ${ADIT_PCL_INCLUDE})
  target_link_libraries(adit_pcl INTERFACE ${ADIT_PCL_IO} ${ADIT_PCL_IO_PLY} ${ADIT_PCL_COMMON})
endif()
