# SPDX-License-Identifier: Apache-2.0
# Object detection on robots with cameras, by OpenCV. OpenCV's own CMake files come with all of it, VTK too; the four
# libraries are found without them.
#   ADIT_VISION  ON when found, unless set; without it robots refuse the key `objects`
find_path(ADIT_OPENCV_INCLUDE opencv2/dnn.hpp PATH_SUFFIXES opencv4)
find_path(ADIT_OPENCV_HOG opencv2/objdetect.hpp PATH_SUFFIXES opencv4)
mark_as_advanced(ADIT_OPENCV_INCLUDE ADIT_OPENCV_HOG)
set(adit_opencv_found ON)
foreach(part core imgproc dnn objdetect)
  find_library(ADIT_OPENCV_${part} opencv_${part})
  mark_as_advanced(ADIT_OPENCV_${part})
  if(NOT ADIT_OPENCV_${part})
    set(adit_opencv_found OFF)
  endif()
endforeach()
if(NOT ADIT_OPENCV_INCLUDE OR NOT ADIT_OPENCV_HOG)
  set(adit_opencv_found OFF)
endif()
option(ADIT_VISION "Detect objects in pictures with OpenCV" ${adit_opencv_found})
if(ADIT_VISION AND NOT adit_opencv_found)
  message(FATAL_ERROR "ADIT_VISION needs libopencv-dnn-dev and libopencv-objdetect-dev (./run setup)")
endif()
