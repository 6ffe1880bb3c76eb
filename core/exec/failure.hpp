// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <exception>
#include <functional>
#include <string>

namespace adit {

/// Called for an exception thrown by a task, or for work that was dropped because a queue was full, with the
/// strand's name and a description. Live, it is called on the thread concerned.
using FailureHandler = std::function<void(const std::string& strand, const std::string& what)>;

/// The default handler: writes one line to stderr, so that no failure is lost when no handler was set.
void report_on_stderr(const std::string& strand, const std::string& what);

/// Text of the exception being handled; call it inside a catch block. HangReleased passes through.
std::string current_exception_text();

}  // namespace adit
