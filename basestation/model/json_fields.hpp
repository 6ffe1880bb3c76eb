// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/model/json_reader.hpp"
#include "basestation/model/map_tiles.hpp"
#include "basestation/model/outcome.hpp"
#include "basestation/model/world.hpp"

/// The keys of each value of the model, for JsonReader::read() and value_from().
namespace adit::station {

void read_fields(JsonReader& in, Epoch& epoch);
void read_fields(JsonReader& in, ModeChoice& choice);
void read_fields(JsonReader& in, ExplorationView& exploration);
void read_fields(JsonReader& in, AreaView& area);
void read_fields(JsonReader& in, Size& size);
void read_fields(JsonReader& in, Robot& robot);
void read_fields(JsonReader& in, Counts& counts);
void read_fields(JsonReader& in, Notice& notice);
void read_fields(JsonReader& in, StationSummary& station);
void read_fields(JsonReader& in, AgentRate& rate);
void read_fields(JsonReader& in, RobotAnswer& answer);
void read_fields(JsonReader& in, MapTile& tile);

}  // namespace adit::station
