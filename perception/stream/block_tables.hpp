// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

namespace adit::perception {

/// The trees of contexts as text, see ContextTrees. Written by bench_map_train.
extern const char* const kBlockTables;
extern const std::size_t kBlockTablesSize;

}  // namespace adit::perception
