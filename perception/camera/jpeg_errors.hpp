// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <csetjmp>
#include <cstdio>

#include <jpeglib.h>

#include <jerror.h>

namespace adit::perception {

/// Errors of libjpeg that jump back into our code instead of ending the process. The function that calls
/// setjmp() owns nothing that has a destructor, as none would run.
struct JpegJump {
  jpeg_error_mgr base{};
  std::jmp_buf target{};
  bool strict{};  ///< A warning of damaged data ends the call too.
  bool too_many_scans{};

  jpeg_error_mgr* install() {
    jpeg_std_error(&base);
    base.error_exit = &JpegJump::leave;
    base.output_message = [](j_common_ptr) {};
    base.emit_message = [](j_common_ptr info, int level) {
      // Many cameras write bytes between two segments, which lose nothing.
      if (level >= 0 || info->err->msg_code == JWRN_EXTRANEOUS_DATA) return;
      ++info->err->num_warnings;
      if (reinterpret_cast<JpegJump*>(info->err)->strict) leave(info);
    };
    return &base;
  }
  static void leave(j_common_ptr info) { std::longjmp(reinterpret_cast<JpegJump*>(info->err)->target, 1); }
};

}  // namespace adit::perception
