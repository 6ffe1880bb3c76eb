// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

#include "bench/map_link/recording.hpp"
#include "perception/stream/piece.hpp"

namespace adit::bench {

/// Calls `visit` with each piece that a robot sends of a recorded mission to a station that hears everything
/// and acknowledges it a second later, and with what the station has then.
void visit_sent(const MapRecording& recording, std::size_t max_bytes,
                const std::function<void(const perception::MapPiece&, const perception::FindStored&)>& visit);

}  // namespace adit::bench
