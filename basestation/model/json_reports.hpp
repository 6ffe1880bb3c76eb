// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/model/found.hpp"
#include "basestation/model/health.hpp"
#include "basestation/model/json_reader.hpp"
#include "basestation/model/network.hpp"

/// The reports of queries as JSON and back, as model/json.hpp for the rest of the model.
namespace adit::station {

nlohmann::json json_of(const ComponentView& component);
nlohmann::json json_of(const RobotHealth& health);
nlohmann::json json_of(const HealthReport& report);
nlohmann::json json_of(const TopicRate& rate);
nlohmann::json json_of(const AgentTraffic& traffic);
nlohmann::json json_of(const SenderReport& sender);
nlohmann::json json_of(const LinkReport& link);
nlohmann::json json_of(const NetworkReport& report);
nlohmann::json json_of(const FoundItem& item);
nlohmann::json json_of(const FoundAtRobot& robot);
nlohmann::json json_of(const FoundReport& report);

void read_fields(JsonReader& in, ComponentView& component);
void read_fields(JsonReader& in, RobotHealth& health);
void read_fields(JsonReader& in, HealthReport& report);
void read_fields(JsonReader& in, TopicRate& rate);
void read_fields(JsonReader& in, AgentTraffic& traffic);
void read_fields(JsonReader& in, SenderReport& sender);
void read_fields(JsonReader& in, LinkReport& link);
void read_fields(JsonReader& in, NetworkReport& report);
void read_fields(JsonReader& in, FoundItem& item);
void read_fields(JsonReader& in, FoundAtRobot& robot);
void read_fields(JsonReader& in, FoundReport& report);

}  // namespace adit::station
