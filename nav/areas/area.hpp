// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/geometry/area.hpp"
#include "core/result/result.hpp"

namespace adit::nav {

using adit::Area;
using adit::AreaKind;
using adit::kAreaKinds;

/// Checks an area and returns it with its corners counter-clockwise. Two corners are opposite ones of a
/// rectangle with sides along the axes. Error: bad_argument for a name that is not valid, numbers that are
/// not finite or too large, a number of corners outside [2, 16], sides that touch or cross, and nothing
/// enclosed.
Result<Area> checked(Area area);

}  // namespace adit::nav
