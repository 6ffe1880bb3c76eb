// SPDX-License-Identifier: Apache-2.0
// Photos of findings in the window: thumbnails in the rows, and one that is open.
#include <QBuffer>
#include <QPainter>

#include "basestation/gui/bridge/photo_loader.hpp"
#include "basestation/model/photo_bytes.hpp"
#include "core/findings/photo.hpp"
#include "tests/gui/fake_drive.hpp"
#include "tests/gui/tabs_fixture.hpp"

namespace adit::gui {
namespace {

using findings::PhotoPart;
using station::PhotoHere;

/// A corridor with somebody in a red jacket at its end.
store::Bytes jpeg_of_a_corridor() {
  QImage image(1280, 960, QImage::Format_RGB32);
  image.fill(QColor(70, 74, 82));
  QPainter painter(&image);
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(120, 118, 110));
  painter.drawPolygon(QPolygon({QPoint(0, 960), QPoint(480, 560), QPoint(800, 560), QPoint(1280, 960)}));
  painter.setBrush(QColor(30, 32, 36));
  painter.drawRect(480, 300, 320, 260);
  painter.setBrush(QColor(200, 40, 30));
  painter.drawRoundedRect(560, 430, 160, 200, 30, 30);
  painter.setBrush(QColor(224, 190, 160));
  painter.drawEllipse(600, 350, 80, 90);
  painter.end();
  QByteArray bytes;
  QBuffer buffer(&bytes);
  EXPECT_TRUE(image.save(&buffer, "JPG", 85));
  return {bytes.begin(), bytes.end()};
}

station::FoundReport findings_with_photos() {
  station::FoundReport report = some_findings();
  report.findings[0].photo = station::FoundPhoto{PhotoHere::whole, 100, 90'000, "00000000000000a2"};
  report.findings[1].photo = station::FoundPhoto{PhotoHere::thumbnail, 40, 120'000, "00000000000000a1"};
  report.findings[2].photo = station::FoundPhoto{PhotoHere::none, 0, 50'000, "00000000000000a3"};
  return report;
}

class PhotoWindow : public TabsTest {
 protected:
  static station::CommandOutcome outcome_of(const store::Bytes& jpeg) {
    return {.json = station::line_of(station::photo_json(jpeg))};
  }
  /// Opens the tab with these findings.
  void list(const station::FoundReport& report) {
    open("findings");
    answer(answer_of(report));
    settle_layout();
  }
  bool asked_for(std::size_t photos) {
    return QTest::qWaitFor([&] { return sink.photos.size() >= photos; }, 30'000);
  }
  /// Answers everything that was asked for with the drawn photo.
  void answer_photos() {
    for (const FakeSink::AskedPhoto& asked : std::exchange(sink.photos, {}))
      asked.done(outcome_of(asked.part == PhotoPart::picture ? photo_.picture : photo_.thumbnail));
  }
  bool is_shown(const QString& image) {
    return QTest::qWaitFor([&] { return item(image)->property("sourceSize").toSize().width() > 1; }, 30'000);
  }
  /// The colour of the window at a share of an item's width and height.
  QColor colour_at(const QString& name, double x, double y) {
    settle();
    const QImage seen = window()->grabWindow();
    const QQuickItem* of = item(name);
    return seen.pixelColor(of->mapToScene({of->width() * x, of->height() * y}).toPoint());
  }
  bool opened() { return find_item(window(), "largePhoto")->isVisible(); }
  void open_photo(int finding) {
    settle_layout();
    touch(middle(QString("photo_%1").arg(finding)));
  }

  findings::Photo photo_{findings::make_photo(jpeg_of_a_corridor()).value()};
};

void expect_red(const QColor& colour) {
  EXPECT_GT(colour.red(), 140) << colour.name().toStdString();
  EXPECT_LT(colour.green(), 100) << colour.name().toStdString();
}

TEST_F(PhotoWindow, RowsShowTheThumbnailsThatAreHereAndWordsOnTheRest) {
  list(findings_with_photos());
  ASSERT_TRUE(asked_for(2));
  EXPECT_EQ(sink.photos.size(), 2U) << "of the third nothing is here";
  for (const FakeSink::AskedPhoto& asked : sink.photos) EXPECT_EQ(asked.part, PhotoPart::thumbnail);
  answer_photos();
  ASSERT_TRUE(is_shown("thumbnail_2"));
  ASSERT_TRUE(is_shown("thumbnail_1"));
  expect_red(colour_at("thumbnail_2", 0.5, 0.55));
  EXPECT_FALSE(item("thumbnail_3")->isVisible());
  EXPECT_EQ(text("line_2"), "photo: whole   sits at the wall, moves");
  EXPECT_TRUE(text("line_1").startsWith("photo: 40 %   ")) << text("line_1").toStdString();
  EXPECT_TRUE(text("line_3").startsWith("photo: none yet   ")) << text("line_3").toStdString();
  picture("finding_thumbnails");
}

TEST_F(PhotoWindow, APressOpensTheWholePhotoAndEscapeClosesItAlone) {
  list(findings_with_photos());
  ASSERT_TRUE(asked_for(2));
  answer_photos();
  EXPECT_FALSE(opened());
  open_photo(2);
  ASSERT_TRUE(opened());
  ASSERT_TRUE(asked_for(1));
  EXPECT_EQ(sink.photos[0].part, PhotoPart::picture);
  EXPECT_EQ(sink.photos[0].id, "00000000000000a2");
  answer_photos();
  ASSERT_TRUE(is_shown("largePhoto"));
  expect_red(colour_at("largePhoto", 0.5, 0.55));
  EXPECT_TRUE(text("photoTitle").startsWith("2  person"));
  EXPECT_EQ(text("photoText"), "sits at the wall, moves");
  EXPECT_EQ(text("photoLine"), "found by r3   at 12.0 4.0 0.2   75 s ago   id 2");
  EXPECT_EQ(text("photoState"), "the whole photo");
  EXPECT_TRUE(item("stopAll")->isVisible());
  picture("finding_photo");
  QTest::keyClick(window(), Qt::Key_Escape);
  settle();
  EXPECT_FALSE(opened());
  EXPECT_EQ(control.tabs()->open(), "findings");
  EXPECT_TRUE(sink.lines.empty());
}

TEST_F(PhotoWindow, AThumbnailIsEnlargedUntilTheWholePhotoIsHere) {
  station::FoundReport report = findings_with_photos();
  list(report);
  ASSERT_TRUE(asked_for(2));
  answer_photos();
  open_photo(1);
  ASSERT_TRUE(asked_for(1));
  EXPECT_EQ(sink.photos[0].part, PhotoPart::thumbnail);
  answer_photos();
  ASSERT_TRUE(is_shown("largePhoto"));
  expect_red(colour_at("largePhoto", 0.5, 0.55));
  EXPECT_EQ(text("photoState"), "thumbnail, enlarged; 40 % of the photo is here");
  picture("finding_photo_thumbnail");
  report.findings[1].photo->here = PhotoHere::whole;
  control.add_command({.id = 1, .ended = true, .line = "finding 2 confirm", .mine = true});
  answer(answer_of(report));
  EXPECT_EQ(text("photoState"), "the whole photo");
  const auto picture_asked = [&] {
    return std::ranges::any_of(sink.photos,
                               [](const auto& asked) { return asked.part == PhotoPart::picture; });
  };
  EXPECT_TRUE(QTest::qWaitFor(picture_asked, 30'000));
  settle_layout();
  touch(middle("closePhoto"));
  EXPECT_FALSE(opened());
  EXPECT_EQ(control.tabs()->picked(), 0U) << "nothing below it was pressed";
  // A photo whose finding is gone is closed.
  control.tabs()->photos()->show(2);
  settle();
  EXPECT_TRUE(opened());
  report.findings.clear();
  control.add_command({.id = 2, .ended = true, .line = "finding 2 confirm", .mine = true});
  answer(answer_of(report));
  EXPECT_FALSE(opened());
}

TEST_F(PhotoWindow, WhatIsNoPhotoIsSaidInWords) {
  list(findings_with_photos());
  ASSERT_TRUE(asked_for(2));
  store::Bytes cut = photo_.picture;
  cut.resize(cut.size() / 2);
  const std::vector<std::pair<station::CommandOutcome, QString>> bad{
      {outcome_of(cut), "no whole JPEG"},
      {outcome_of({}), "no whole JPEG"},
      {outcome_of(store::Bytes(findings::Photo::kMaxInput + 3, 0xff)), "at most"},
      {{.json = "no JSON"}, "does not fit"},
      {{.exit_code = station::kExitRefused, .error = "the photo is not here\n"}, "not here"}};
  for (const auto& [outcome, words] : bad) {
    sink.photos.clear();
    control.tabs()->photos()->show(2);
    ASSERT_TRUE(QTest::qWaitFor([&] { return !sink.photos.empty(); }, 30'000)) << words.toStdString();
    sink.photos[0].done(outcome);
    EXPECT_TRUE(QTest::qWaitFor([&] { return text("photoState").contains(words); }, 30'000))
        << text("photoState").toStdString() << " instead of " << words.toStdString();
    control.tabs()->photos()->close();
  }
}

TEST_F(PhotoWindow, NotMoreThanAFewAreAskedForAtATime) {
  station::FoundReport report;
  for (std::uint32_t i = 1; i <= 300; ++i)
    report.findings.push_back(
        {.number = i,
         .robot = "r3",
         .kind = "gas",
         .photo = station::FoundPhoto{PhotoHere::thumbnail, 0, 9000, "00000000000000a2"}});
  list(report);
  ASSERT_TRUE(asked_for(PhotoLoader::kMaxAsked));
  settle_layout();
  EXPECT_EQ(sink.photos.size(), std::size_t{PhotoLoader::kMaxAsked});
  std::size_t all = 0;
  while (QTest::qWaitFor([&] { return !sink.photos.empty(); }, 1000)) {
    EXPECT_LE(sink.photos.size(), std::size_t{PhotoLoader::kMaxAsked});
    all += sink.photos.size();
    answer_photos();
  }
  EXPECT_GE(all, std::size_t{PhotoLoader::kMaxAsked});
  EXPECT_LT(all, 60U) << "only of rows that are laid out";
}

TEST_F(PhotoWindow, ADriveClosesThePhoto) {
  FakeDrive drive;
  station::World driven = ten_robots();
  driven.robots[0].mode = "smart_joystick";
  drive.show(driven);
  control.drive()->use(drive, [] { return [] { return station::input::Gamepad::State{}; }; });
  list(findings_with_photos());
  open_photo(2);
  ASSERT_TRUE(opened());
  control.select("r1", false);
  control.drive()->begin("r1");
  EXPECT_TRUE(QTest::qWaitFor([&] { return control.drive()->driving() && !opened(); }, 30'000));
  control.drive()->stop_using();
}

TEST_F(PhotoWindow, TheWindowMayGoWhilePhotosAreAskedFor) {
  list(findings_with_photos());
  ASSERT_TRUE(asked_for(2));
  operator_window.reset();
  answer_photos();
  settle();
}

}  // namespace
}  // namespace adit::gui
