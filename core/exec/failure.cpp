// SPDX-License-Identifier: Apache-2.0
#include "core/exec/failure.hpp"

#include <cstdio>

#include "core/exec/fault.hpp"

namespace adit {

void report_on_stderr(const std::string& strand, const std::string& what) {
  std::fprintf(stderr, "adit: strand %s: %s\n", strand.c_str(), what.c_str());
}

std::string current_exception_text() {
  try {
    throw;
  } catch (const HangReleased&) {
    throw;
  } catch (const std::exception& e) {
    return e.what();
  } catch (...) {
    return "an exception that is no std::exception";
  }
}

}  // namespace adit
