// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/app.hpp"

int main(int argc, char** argv) { return adit::gui::run_program(argc, argv); }
