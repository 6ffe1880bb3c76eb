// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>

#include "basestation/content/piece_reader.hpp"
#include "basestation/findings/desk.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/findings/finding_piece.hpp"
#include "core/store/memory_disk.hpp"
#include "core/time/random.hpp"
#include "core/transfer/sender.hpp"
#include "robot_agent/findings/finding_source.hpp"
#include "tests/findings/some.hpp"

namespace adit::agent {

/// A map that never ends: each piece is of the largest size.
class EndlessMap final : public transfer::Source {
 public:
  transfer::Kind kind() const override { return transfer::Kind::map_blocks; }
  void join(const transfer::PeerId&) override {}
  void leave(const transfer::PeerId&) override {}
  std::size_t missing(const transfer::PeerId&) const override { return 1000; }
  std::optional<Content> next(std::span<const transfer::PeerId>, std::size_t max_bytes, Time) override {
    return Content{++token, std::vector<std::uint8_t>(max_bytes)};
  }
  void acknowledged(const transfer::PeerId&, std::uint64_t) override {}
  void lost(const transfer::PeerId&, std::uint64_t) override {}
  void settled(std::uint64_t) override {}
  std::uint64_t token{};
};

/// A robot's findings on their way to two stations' desks, over a link that may lose or be away.
class FindingSourceTest : public testing::Test {
 protected:
  struct Operator {
    transfer::PeerId id{};
    std::uint32_t start{1};
    std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
    std::unique_ptr<station::PieceReader> pieces{};
    std::unique_ptr<station::FindingDesk> desk{};
    bool heard{true}, answers{true};
    std::vector<std::string> trouble{};
    std::vector<std::pair<std::uint64_t, std::uint32_t>> changes{};  ///< Ids and revisions.
    std::size_t found{};
  };
  FindingSourceTest() {
    start_robot();
    for (std::size_t i = 0; i < 2; ++i) {
      ops[i].id[0] = static_cast<std::uint8_t>(i + 1);
      start(ops[i]);
    }
  }
  void start_robot() {
    source = std::make_unique<FindingSource>(
        params, disk, *strand, nullptr,
        FindingSource::Outputs{[this](const std::string&) { ++full; }, [](bool, const std::string&) {}});
    (void)source->load();
    sender = std::make_unique<transfer::Sender>(transfer::SenderParams{.session = ++session});
    sender->add(*source);
    if (map) sender->add(*map);
  }
  void start(Operator& op, std::size_t most = 1000) {
    ++op.start;
    op.desk.reset();
    op.pieces = std::make_unique<station::PieceReader>(
        [this] { return strand->now(); },
        [&op](const station::PieceReader::Piece& piece, station::PieceReader::Stored stored) {
          if (piece.kind == static_cast<std::uint8_t>(transfer::Kind::findings))
            return op.desk->hear(piece.robot, piece.data, std::move(stored));
          stored();
          return Result<void>{};
        });
    op.desk = std::make_unique<station::FindingDesk>(
        station::DeskParams{most}, op.disk, *strand,
        station::FindingDesk::Outputs{
            [&op](const findings::Finding&) { ++op.found; },
            [&op](const std::string& code, const std::string&) { op.trouble.push_back(code); },
            [&op](const findings::Finding&, const findings::Finding& f) {
              op.changes.emplace_back(f.key.id, f.revision);
            }});
    (void)op.desk->load();
  }
  void send() {
    for (const transfer::Piece& piece : sender->due(strand->now(), link)) {
      if (piece.kind == transfer::Kind::findings) {
        const auto decoded = findings::decode_piece(piece.data);
        ASSERT_TRUE(decoded.ok());
        for (const findings::Finding& f : decoded->findings) {
          sent.push_back(f.key.id);
          revisions_sent.push_back(f.revision);
        }
        if (on_sent) on_sent(piece.id, *decoded);
        largest = std::max(largest, piece.data.size());
      }
      kinds.push_back(piece.kind);
      for (Operator& op : ops)
        if (op.heard && !random.chance(loss))
          transmit([&op, piece, number = session] {
            op.pieces->take(
                {"r1", number, piece.id, static_cast<std::uint8_t>(piece.kind), piece.waiting, piece.data});
          });
    }
  }
  /// Delivers at once, or where the link repeats and reorders later, and perhaps twice.
  void transmit(const std::function<void()>& deliver) {
    for (int copies = random.chance(repeats) ? 2 : 1; copies > 0; --copies)
      if (latency > Duration{})
        air.emplace(strand->now() + latency, deliver);
      else if (random.chance(delays))
        air.emplace(strand->now() + random.below(60) * 100ms, deliver);
      else
        deliver();
  }
  void run(Duration span) {
    for (const Time end = strand->now() + span; strand->now() < end;
         scheduler.run_until(scheduler.elapsed() + 50ms)) {
      while (!air.empty() && air.begin()->first <= strand->now()) {
        air.begin()->second();
        air.erase(air.begin());
      }
      source->tick(strand->now());
      send();
      for (Operator& op : ops) {
        const auto receipts = op.pieces->due(link.link != nullptr ? link.link->bandwidth : 20e6);
        if (!receipts || !op.heard || !op.answers || random.chance(loss)) continue;
        transfer::Ack ack{op.id, op.start, {}};
        if (!receipts->empty()) ack.receipt = receipts->front().second;
        transmit([this, &op, ack] {
          sender->acknowledged(ack, strand->now());
          if (on_receipt) on_receipt(op, ack.receipt);
          source->heard(op.id, strand->now());
        });
      }
    }
  }
  std::uint64_t report(std::uint64_t id, std::uint8_t importance = 1) {
    const auto made = source->report(findings::some(id, importance));
    return made ? *made : 0;
  }
  /// A finding with content that differs for each number.
  static findings::Finding content(std::uint64_t id, int number) {
    findings::Finding f = findings::some(id);
    f.text = "seen " + std::to_string(number) + " times";
    return f;
  }
  findings::Finding at(const Operator& op, std::uint64_t id) const { return op.desk->all().at({"r1", id}); }
  /// Ends and begins the silence of the stations, longer than a sender waits for one.
  void gap(Duration span) {
    for (Operator& op : ops) op.heard = false;
    run(span);
  }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 5s)};
  std::shared_ptr<Executor> strand{machine->strand("command")};
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  FindingParams params{.robot = "r1", .max_findings = 8};
  wire::SenderState link{};
  double loss{}, repeats{}, delays{};
  Duration latency{};
  std::multimap<Time, std::function<void()>> air{};
  Random random{3};
  std::array<Operator, 2> ops{};
  std::unique_ptr<EndlessMap> map{};
  std::unique_ptr<FindingSource> source{};
  std::unique_ptr<transfer::Sender> sender{};
  std::uint32_t session{};
  std::vector<std::uint64_t> sent{};
  std::vector<std::uint32_t> revisions_sent{};
  std::function<void(std::uint32_t piece, const findings::FindingPiece&)> on_sent{};
  std::function<void(const Operator&, const transfer::Receipt&)> on_receipt{};
  std::vector<transfer::Kind> kinds{};
  std::size_t largest{};
  int full{};
};

}  // namespace adit::agent
