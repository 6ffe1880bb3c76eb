// SPDX-License-Identifier: Apache-2.0
#include "nav/areas/area_set.hpp"

int main() { return adit::nav::AreaSet().permits(Eigen::Vector3d(1, 2, 3)) ? 0 : 1; }
