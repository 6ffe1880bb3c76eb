// SPDX-License-Identifier: Apache-2.0
// Photos on their way from a robot to a station, over a link that loses, is cut, and between restarts.
#include <gmock/gmock.h>

#include "basestation/content/piece_reader.hpp"
#include "basestation/findings/photo_desk.hpp"
#include "core/findings/photo_source.hpp"
#include "tests/findings/drawn_photo.hpp"
#include "tests/findings/source_bench.hpp"

namespace adit::findings {
namespace {

/// A robot with findings and photos, and a station.
class PhotoLinkTest : public testing::Test {
 protected:
  PhotoLinkTest() {
    start_robot();
    start_station();
  }
  void start_robot() {
    sender.reset();
    sources.reset();
    source = std::make_unique<agent::FindingSource>(
        agent::FindingParams{.robot = "r1"}, robot_disk, *strand, nullptr,
        agent::FindingSource::Outputs{[](const auto&) {}, [](bool, const auto&) {}, {}});
    (void)source->load();
    photos =
        std::make_unique<PhotoStore>(PhotoStoreParams{}, robot_disk, *strand, nullptr, PhotoStore::Outputs{});
    (void)photos->load();
    sources = std::make_unique<PhotoSources>(*photos, robot_disk, *strand, nullptr);
    sources->ledger.load();
    sender = std::make_unique<transfer::Sender>(transfer::SenderParams{.session = ++session});
    sender->add(*source);
    sender->add(sources->thumbnails);
    if (map) sender->add(*map);
    sender->add(sources->pictures);
  }
  void start_station() {
    ++start;
    photo_desk.reset();
    desk = std::make_unique<station::FindingDesk>(
        station::DeskParams{}, station_disk, *strand,
        station::FindingDesk::Outputs{
            [](const Finding&) {}, [](const std::string&, const std::string&) {}, {}});
    (void)desk->load();
    photo_desk = std::make_unique<station::PhotoDesk>(
        *desk, station_disk, *strand, [](const std::string&, const std::string&) {}, [] {});
    EXPECT_EQ(photo_desk->load(), "");
    pieces = std::make_unique<station::PieceReader>(
        [this] { return strand->now(); },
        [this](const station::PieceReader::Piece& piece,
               station::PieceReader::Stored stored) -> Result<void> {
          if (piece.kind == static_cast<std::uint8_t>(transfer::Kind::findings))
            return desk->hear("r1", piece.data, std::move(stored));
          if (piece.kind == static_cast<std::uint8_t>(transfer::Kind::photos))
            return photo_desk->hear("r1", std::nullopt, piece.data, std::move(stored));
          stored();
          return {};
        });
  }
  void report(std::uint64_t id, const Photo& photo, std::uint8_t importance = 5) {
    Finding finding = some(id, importance);
    finding.photo = ref_of(photo);
    ASSERT_TRUE(photos->put(photo, importance));
    ASSERT_TRUE(source->report(finding).ok());
  }
  void step() {
    source->tick(strand->now());
    sources->ledger.offer(photos_of(source->finding_store().all(), [](const Finding&) { return true; }));
    sources->ledger.tick(strand->now());
    for (const transfer::Piece& piece : sender->due(strand->now(), link)) {
      bytes += piece.data.size();
      kinds.push_back(piece.kind);
      if (piece.kind == transfer::Kind::photos) {
        ++photo_pieces;
        largest = std::max(largest, piece.data.size());
      }
      if (!cut && !random.chance(loss))
        pieces->take(
            {"r1", session, piece.id, static_cast<std::uint8_t>(piece.kind), piece.waiting, piece.data});
    }
    const auto receipts = pieces->due(link.link != nullptr ? link.link->bandwidth : 20e6);
    if (!receipts || cut || random.chance(loss)) return;
    transfer::Ack ack{peer, start, {}};
    if (!receipts->empty()) ack.receipt = receipts->front().second;
    sender->acknowledged(ack, strand->now());
    source->heard(peer, strand->now());
    sources->ledger.heard(peer, strand->now());
  }
  void run(Duration span) {
    for (const Time end = strand->now() + span; strand->now() < end;
         scheduler.run_until(scheduler.elapsed() + 50ms))
      step();
  }
  /// Seconds until it is so; 1000: never.
  double until(const std::function<bool()>& done) {
    const Time begin = strand->now();
    while (!done() && strand->now() - begin < 1000s) run(50ms);
    return seconds(strand->now() - begin);
  }
  bool has(const Photo& photo, PhotoPart part) const {
    const store::Bytes* here = photo_desk->photos().find(photo.hash, part);
    return here != nullptr && *here == (part == PhotoPart::picture ? photo.picture : photo.thumbnail);
  }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 5s)};
  std::shared_ptr<Executor> strand{machine->strand("command")};
  std::shared_ptr<store::MemoryDisk> robot_disk{std::make_shared<store::MemoryDisk>()},
      station_disk{std::make_shared<store::MemoryDisk>()};
  transfer::PeerId peer{1};
  wire::SenderState link{};
  double loss{};
  bool cut{};
  Random random{3};
  std::unique_ptr<agent::EndlessMap> map{};
  std::unique_ptr<agent::FindingSource> source{};
  std::unique_ptr<PhotoStore> photos{};
  std::unique_ptr<PhotoSources> sources{};
  std::unique_ptr<transfer::Sender> sender{};
  std::unique_ptr<station::FindingDesk> desk{};
  std::unique_ptr<station::PhotoDesk> photo_desk{};
  std::unique_ptr<station::PieceReader> pieces{};
  std::uint32_t session{}, start{};
  std::size_t bytes{}, photo_pieces{}, largest{};
  std::vector<transfer::Kind> kinds{};
};

TEST_F(PhotoLinkTest, ArriveWholeOverALossyLink) {
  loss = 0.1;
  const Photo photo = drawn_photo(60);
  report(1, photo);
  EXPECT_LT(until([&] { return has(photo, PhotoPart::thumbnail); }), 6.0);
  EXPECT_LT(until([&] { return has(photo, PhotoPart::picture); }), 60.0);
  EXPECT_LE(largest, 1000U);
  run(20s);
  const std::size_t sent = photo_pieces;
  run(60s);
  EXPECT_EQ(photo_pieces, sent) << "everything is acknowledged";
}

TEST_F(PhotoLinkTest, ThumbnailsGoBeforeTheMapAndPicturesBehindIt) {
  map = std::make_unique<agent::EndlessMap>();
  start_robot();
  const Photo photo = drawn_photo(20);
  report(1, photo);
  EXPECT_LT(until([&] { return has(photo, PhotoPart::thumbnail); }), 6.0);
  run(60s);
  EXPECT_EQ(photo_desk->photos().state(photo.hash).percent, 0) << "the map never ends";
  sender.reset();
  map.reset();
  start_robot();
  EXPECT_LT(until([&] { return has(photo, PhotoPart::picture); }), 30.0);
}

TEST_F(PhotoLinkTest, GoOnAfterACutAndRestartsOfBothSides) {
  const wire::LinkProfile mesh{.name = "mesh_100k", .bandwidth = 100e3, .latency = 0.15};
  link.link = &mesh;
  loss = 0.05;
  const Photo photo = drawn_photo(200);
  report(1, photo);
  const auto percent = [&] { return photo_desk->photos().state(photo.hash).percent; };
  (void)until([&] { return percent() >= 25; });
  cut = true;
  run(40s);
  cut = false;
  const int before_restarts = percent();
  (void)until([&] { return percent() >= 50; });
  run(10s);
  start_robot();
  start_station();
  EXPECT_GE(percent(), before_restarts) << "what was here is still here";
  EXPECT_LT(until([&] { return has(photo, PhotoPart::picture); }), 200.0);
  EXPECT_LT(photo_pieces, 2 * blocks_of(photo.picture.size())) << "only what was on its way went twice";
}

TEST_F(PhotoLinkTest, TheMostImportantGoesFirst) {
  const Photo low = drawn_photo(100, 1), high = drawn_photo(100, 2);
  report(1, low, 3);
  report(2, high, 9);
  (void)until([&] { return has(high, PhotoPart::picture); });
  EXPECT_FALSE(has(low, PhotoPart::picture));
  EXPECT_TRUE(has(low, PhotoPart::thumbnail)) << "all thumbnails go before pictures";
}

TEST_F(PhotoLinkTest, OfFindingsThatAStationDoesNotHaveAreRefusedAndRest) {
  const Photo photo = drawn_photo(20);
  ASSERT_TRUE(photos->put(photo, 5));
  Finding unknown = some(9);
  unknown.photo = ref_of(photo);
  std::size_t refused = 0;
  for (std::size_t i = 0; i < 40; ++i) {
    PhotoPiece piece{.part = PhotoPart::thumbnail,
                     .content = photo.hash,
                     .bytes = static_cast<std::uint32_t>(photo.thumbnail.size()),
                     .data = store::Bytes(photo.thumbnail.begin(), photo.thumbnail.begin() + kPhotoBlock)};
    pieces->take({"r1", 1, static_cast<std::uint32_t>(i + 1),
                  static_cast<std::uint8_t>(transfer::Kind::photos), 0, encode(piece)});
    refused = pieces->refused(transfer::Kind::photos);
  }
  EXPECT_EQ(refused, 40U);
  EXPECT_EQ(photo_desk->photos().size(), 0U);
}

}  // namespace
}  // namespace adit::findings
