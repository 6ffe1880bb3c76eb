#pragma once
#include <exception>
#include <functional>
#include <string>

namespace adit {

/// Told of an exception that left a task, or of work that was dropped because a queue was full: the
/// strand's name, and what happened. Live it is called on the thread concerned.
using FailureHandler = std::function<void(const std::string& strand, const std::string& what)>;

/// The default handler: one line on stderr, so that nothing is lost when nobody asked to be told.
void report_on_stderr(const std::string& strand, const std::string& what);

/// The text of the exception being handled; call it inside a catch block. HangReleased passes through.
std::string current_exception_text();

}  // namespace adit
