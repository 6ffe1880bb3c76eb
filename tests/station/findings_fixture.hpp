// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/findings/report.hpp"
#include "core/findings/finding_piece.hpp"
#include "core/store/memory_disk.hpp"
#include "tests/station/fake_robot.hpp"

namespace adit::station {

/// What a station stores of findings, and the report of them.
class StoredFindings : public StationTest {
 protected:
  StoredFindings()
      : book_(nullptr, *strand_),
        desk_({}, std::make_shared<store::MemoryDisk>(), *strand_,
              {[this](const findings::Finding& f) { book_.add(f.key); },
               [](const std::string&, const std::string&) {}}) {}

  /// A finding comes from its robot.
  void find(const findings::Finding& finding) {
    ASSERT_TRUE(desk_.hear(finding.key.robot, findings::encode({finding.key.robot, 1, 0, {finding}}), [] {}));
  }
  FoundReport found() { return findings_report(desk_, book_, marks_, photos_, chunks_, fleet_, {}); }

  FindingBook book_;
  FindingDesk desk_;
  Marks marks_{"op1", {1}, 1, desk_, *strand_};
  findings::PhotoStore photos_{{}, nullptr, *strand_, nullptr, {}};
  ChunkStore chunks_;
  Fleet fleet_{"op1", {1}};
};

}  // namespace adit::station
