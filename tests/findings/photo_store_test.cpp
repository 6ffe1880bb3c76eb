// SPDX-License-Identifier: Apache-2.0
// Photos of findings on the disk of a robot or station.
#include "core/findings/photo_store.hpp"

#include <gmock/gmock.h>

#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"
#include "tests/findings/drawn_photo.hpp"

namespace adit::findings {
namespace {

using testing::HasSubstr;

class PhotoStoreTest : public testing::Test {
 protected:
  PhotoStoreTest() { start(); }
  std::string start(PhotoStoreParams params = {}) {
    photos = std::make_unique<PhotoStore>(
        params, disk, *strand, nullptr,
        PhotoStore::Outputs{[this](bool is, const std::string&) { failing = is; },
                            [this](const std::string&) { ++full; },
                            {}});
    return photos->load();
  }
  void run(Duration span = 100ms) { scheduler.run_until(scheduler.elapsed() + span); }
  PhotoPiece piece_of(const Photo& photo, PhotoPart part, std::size_t block) const {
    const store::Bytes& all = part == PhotoPart::picture ? photo.picture : photo.thumbnail;
    PhotoPiece piece{.part = part,
                     .content = photo.hash,
                     .bytes = static_cast<std::uint32_t>(all.size()),
                     .first = static_cast<std::uint16_t>(block)};
    const auto data = std::span(all).subspan(block * kPhotoBlock);
    piece.data.assign(data.begin(),
                      data.begin() + static_cast<std::ptrdiff_t>(std::min(data.size(), kPhotoBlock)));
    return piece;
  }
  Result<void> add(const Photo& photo, PhotoPart part, std::size_t block, std::uint8_t importance = 5) {
    return photos->add(piece_of(photo, part, block), ref_of(photo), importance, "r1", [this] { ++stored; });
  }
  void add_all(const Photo& photo, PhotoPart part) {
    const std::size_t bytes = part == PhotoPart::picture ? photo.picture.size() : photo.thumbnail.size();
    for (std::size_t i = 0; i < blocks_of(bytes); ++i) EXPECT_TRUE(add(photo, part, i).ok()) << i;
  }
  std::vector<std::string> files() const { return disk->list().value(); }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 5s)};
  std::shared_ptr<Executor> strand{machine->strand("home")};
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::unique_ptr<PhotoStore> photos{};
  int stored{}, full{};
  bool failing{};
};

TEST_F(PhotoStoreTest, RefusesAThumbnailThatClaimsManyPixels) {
  Photo photo = drawn_photo();
  photo.thumbnail = draw({.width = 136, .height = 16, .quality = 5});
  ASSERT_LE(photo.thumbnail.size(), std::size_t{PhotoRef::kMaxThumbnail});
  for (std::size_t i = 0; i < blocks_of(photo.thumbnail.size()); ++i)
    EXPECT_EQ(add(photo, PhotoPart::thumbnail, i).ok(), i + 1 < blocks_of(photo.thumbnail.size())) << i;
  EXPECT_FALSE(photos->state(photo.hash).thumbnail);
}

TEST_F(PhotoStoreTest, KeepsAPhotoOverARestart) {
  const Photo photo = drawn_photo();
  ASSERT_TRUE(photos->put(photo, 7));
  EXPECT_FALSE(photos->is_stored(photo.hash));
  run();
  EXPECT_TRUE(photos->is_stored(photo.hash));
  EXPECT_EQ(start(), "");
  ASSERT_NE(photos->find(photo.hash, PhotoPart::picture), nullptr);
  EXPECT_EQ(*photos->find(photo.hash, PhotoPart::picture), photo.picture);
  EXPECT_EQ(*photos->find(photo.hash, PhotoPart::thumbnail), photo.thumbnail);
  EXPECT_TRUE(photos->state(photo.hash).whole);
}

TEST_F(PhotoStoreTest, AcknowledgesBlocksOnceTheyAreOnTheDisk) {
  const Photo photo = drawn_photo();
  add_all(photo, PhotoPart::thumbnail);
  EXPECT_EQ(stored, 0);
  run();
  EXPECT_EQ(stored, static_cast<int>(blocks_of(photo.thumbnail.size())));
  EXPECT_TRUE(photos->state(photo.hash).thumbnail);
  EXPECT_FALSE(photos->state(photo.hash).whole);
  EXPECT_EQ(photos->find(photo.hash, PhotoPart::picture), nullptr);
}

TEST_F(PhotoStoreTest, GoesOnWithHalfAPhotoAfterARestart) {
  const Photo photo = drawn_photo();
  const std::size_t blocks = blocks_of(photo.picture.size());
  add_all(photo, PhotoPart::thumbnail);
  for (std::size_t i = 0; i < blocks; i += 2) EXPECT_TRUE(add(photo, PhotoPart::picture, i).ok());
  run();
  EXPECT_EQ(start(), "");
  EXPECT_NEAR(photos->state(photo.hash).percent, 50, 2);
  stored = 0;
  EXPECT_TRUE(add(photo, PhotoPart::picture, 0).ok());
  EXPECT_EQ(stored, 1) << "it is on the disk already";
  for (std::size_t i = 1; i < blocks; i += 2) EXPECT_TRUE(add(photo, PhotoPart::picture, i).ok());
  run();
  EXPECT_EQ(*photos->find(photo.hash, PhotoPart::picture), photo.picture);
  EXPECT_EQ(files(), std::vector<std::string>{photo_file_name(photo.hash, true)});
  EXPECT_EQ(start(), "");
  EXPECT_TRUE(photos->state(photo.hash).whole);
}

TEST_F(PhotoStoreTest, APowerCutAtAnyStepLosesNoBlockThatWasAcknowledged) {
  const Photo photo = drawn_photo(4);
  const std::size_t blocks = blocks_of(photo.picture.size());
  for (std::uint64_t cut = 0; cut < 8000; cut += 97) {
    disk = std::make_shared<store::MemoryDisk>(cut + 1);
    (void)start();
    disk->cut_power_after(cut);
    std::vector<std::size_t> acknowledged;
    add_all(photo, PhotoPart::thumbnail);
    for (std::size_t i = 0; i < blocks; ++i) {
      (void)photos->add(piece_of(photo, PhotoPart::picture, i), ref_of(photo), 5, "r1",
                        [&acknowledged, i] { acknowledged.push_back(i); });
      run(10ms);
    }
    photos.reset();
    disk->power_up();
    (void)start();
    run();  // It writes again what was cut.
    for (const std::size_t i : acknowledged) {
      int known = 0;
      (void)photos->add(piece_of(photo, PhotoPart::picture, i), ref_of(photo), 5, "r1",
                        [&known] { ++known; });
      EXPECT_EQ(known, 1) << "block " << i << " after " << cut << " steps";
    }
    photos.reset();
  }
}

TEST_F(PhotoStoreTest, SetsDamagedFilesAside) {
  const Photo photo = drawn_photo(), other = drawn_photo(20, 2);
  ASSERT_TRUE(photos->put(photo, 5));
  ASSERT_TRUE(add(other, PhotoPart::thumbnail, 0).ok());
  run();
  for (const std::string& name : files()) {
    store::Bytes bytes = disk->read(name).value().value();
    bytes[bytes.size() / 2] ^= 1;
    if (name.ends_with(".part")) bytes[3] ^= 1;  // The head.
    disk->plant(name, bytes);
  }
  disk->plant("photo-0123456789abcdef", {1, 2, 3});
  EXPECT_THAT(start(), HasSubstr("no file was deleted"));
  EXPECT_EQ(photos->size(), 0U);
  EXPECT_EQ(files().size(), 3U);
  for (const std::string& name : files())
    EXPECT_TRUE(name.find(".c") != std::string::npos || name.find(".torn") != std::string::npos ||
                name.find(".foreign") != std::string::npos)
        << name;
  EXPECT_EQ(start(), "") << "they are not read again";
  EXPECT_TRUE(photos->put(photo, 5)) << "it comes again";
  run();
  EXPECT_TRUE(photos->is_stored(photo.hash));
}

TEST_F(PhotoStoreTest, DropsTheLeastImportantThenTheOldest) {
  std::vector<Photo> all;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) all.push_back(drawn_photo(20, seed));
  std::size_t three = 0;
  for (int i = 0; i < 3; ++i) three += all[0].picture.size() + Photo::kMaxThumbnail;
  (void)start({.max_bytes = three});
  EXPECT_TRUE(photos->put(all[0], 5));
  EXPECT_TRUE(photos->put(all[1], 9));
  EXPECT_TRUE(photos->put(all[2], 5));
  run();
  EXPECT_EQ(full, 0);
  EXPECT_FALSE(photos->put(all[3], 4)) << "all others are more important";
  EXPECT_TRUE(photos->put(all[3], 5));
  EXPECT_EQ(photos->find(all[0].hash, PhotoPart::picture), nullptr) << "the oldest of the least important";
  EXPECT_EQ(full, 1);
  run();
  EXPECT_EQ(files().size(), 3U);
  EXPECT_EQ(start({.max_bytes = three}), "");
  EXPECT_EQ(photos->size(), 3U);
}

TEST_F(PhotoStoreTest, RefusesWhatDoesNotFitItsFinding) {
  const Photo photo = drawn_photo();
  PhotoRef wrong = ref_of(photo);
  wrong.bytes += 1;
  const PhotoPiece piece = piece_of(photo, PhotoPart::picture, 0);
  EXPECT_EQ(photos->add(piece, wrong, 5, "r1", {}).reason(), Reason::malformed);
  ASSERT_TRUE(add(photo, PhotoPart::thumbnail, 0).ok());
  wrong.bytes -= 1;
  wrong.thumbnail += 1;
  EXPECT_EQ(photos->add(piece, wrong, 5, "r1", {}).reason(), Reason::malformed) << "of another finding";
}

TEST_F(PhotoStoreTest, RefusesAPictureOfAnotherHash) {
  const Photo photo = drawn_photo(4);
  add_all(photo, PhotoPart::thumbnail);
  const std::size_t blocks = blocks_of(photo.picture.size());
  PhotoPiece forged = piece_of(photo, PhotoPart::picture, 1);
  forged.data[7] ^= 1;
  const std::size_t before = photos->bytes();
  EXPECT_TRUE(photos->add(forged, ref_of(photo), 5, "r1", {}).ok());
  for (std::size_t i = 0; i + 1 < blocks; ++i) EXPECT_TRUE(add(photo, PhotoPart::picture, i).ok());
  EXPECT_EQ(add(photo, PhotoPart::picture, blocks - 1).reason(), Reason::malformed);
  EXPECT_EQ(photos->find(photo.hash, PhotoPart::picture), nullptr);
  EXPECT_EQ(photos->bytes(), before) << "it takes no room";
  run();
  add_all(photo, PhotoPart::picture);
  EXPECT_TRUE(photos->state(photo.hash).whole) << "the genuine one may still come";
}

TEST_F(PhotoStoreTest, RefusesAThumbnailThatIsNoJpegOrABombOfPixels) {
  Photo photo = drawn_photo(4);
  photo.thumbnail.assign(300, 7);
  EXPECT_EQ(add(photo, PhotoPart::thumbnail, 0).reason(), Reason::malformed);
  photo = drawn_photo(4, 2);
  for (std::size_t i = 0; i + 8 < photo.thumbnail.size(); ++i)
    if (photo.thumbnail[i] == 0xff && photo.thumbnail[i + 1] == 0xc0)
      photo.thumbnail[i + 5] = photo.thumbnail[i + 7] = 0x7f;  // 32 thousand pixels of each side.
  Result<void> last{};
  for (std::size_t i = 0; i < blocks_of(photo.thumbnail.size()); ++i)
    last = add(photo, PhotoPart::thumbnail, i);
  EXPECT_EQ(last.reason(), Reason::out_of_range);
}

TEST_F(PhotoStoreTest, ASenderCannotFillItWithPhotosThatNeverEnd) {
  (void)start({.max_bytes = 4 << 20, .max_incoming = 3});
  for (std::uint64_t n = 1; n <= 100; ++n) {
    const PhotoRef ref{n, PhotoRef::kMaxBytes, 100};
    const PhotoPiece piece{
        .part = PhotoPart::picture, .content = n, .bytes = ref.bytes, .data = store::Bytes(kPhotoBlock, 1)};
    const auto added = photos->add(piece, ref, 255, "r1", {});
    EXPECT_EQ(added.ok(), n <= 3) << n;
  }
  EXPECT_LT(photos->bytes(), 900'000U);
  EXPECT_TRUE(photos->put(drawn_photo(), 1));
}

TEST_F(PhotoStoreTest, AFailingDiskAcknowledgesNothingAndIsTriedAgain) {
  const Photo photo = drawn_photo(4);
  disk->set_full(true);
  add_all(photo, PhotoPart::thumbnail);
  run(3s);
  EXPECT_EQ(stored, 0);
  EXPECT_TRUE(failing);
  disk->set_full(false);
  run(2s);
  EXPECT_EQ(stored, static_cast<int>(blocks_of(photo.thumbnail.size())));
  EXPECT_FALSE(failing);
  (void)start();
  EXPECT_TRUE(photos->state(photo.hash).thumbnail);
}

}  // namespace
}  // namespace adit::findings
