// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/map_item_2d.hpp"

#include <QElapsedTimer>
#include <QPainter>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "basestation/gui/scene/mark_list.hpp"
#include "basestation/gui/scene/theme.hpp"

namespace adit::gui {
namespace {

using station::MapTile;

constexpr QRgb kGhostAlpha = 38;  // Of what is on other floors: 15 %.
constexpr int kBudgetMs = 20;     // For new pictures in one frame.
constexpr double kClutter = 0.6;  // Height up to which things have the colour of low ones, m.
constexpr double kWall = 1.4;     // Height from which they have that of walls, m.

}  // namespace

QImage image_of(const MapTile& tile, double resolution, const Palette& palette,
                const std::optional<Floor>& floor) {
  constexpr int kSide = MapTile::kSide;
  QImage image(kSide, kSide, QImage::Format_ARGB32_Premultiplied);
  image.fill(Qt::transparent);
  if (tile.cells.size() != static_cast<std::size_t>(kSide) * kSide) return image;
  std::array<Rgb, 256> plain{};
  plain[MapTile::kGround] = palette.floor;
  for (std::size_t n = MapTile::kThing; n < plain.size(); ++n) {
    const double height = static_cast<double>(n - 1) * resolution;
    const double share = (height - kClutter) / (kWall - kClutter);
    plain[n] = mixed(palette.low, palette.high, std::clamp(share, 0.0, 1.0));
  }
  std::array<QRgb, 256> colours{};
  std::vector<std::uint8_t> sliced;
  if (floor) slice_cells(tile, resolution, *floor, sliced);
  const std::vector<std::uint8_t>& codes = floor ? sliced : tile.cells;
  for (std::size_t n = MapTile::kGround; n < colours.size(); ++n) {
    if (!floor || n < kGhost)
      colours[n] = 0xFF000000U | plain[n];
    else if (n > kGhost)
      colours[n] = qPremultiply(kGhostAlpha << 24 | mixed(palette.low, palette.high, 0.5));
  }
  for (int row = 0; row < kSide; ++row) {
    const std::uint8_t* cells = codes.data() + static_cast<std::ptrdiff_t>(row) * kSide;
    QRgb* line =
        reinterpret_cast<QRgb*>(image.scanLine(kSide - 1 - row));  // The first row is the southernmost.
    for (int column = 0; column < kSide; ++column) line[column] = colours[cells[column]];
  }
  return image;
}

MapItem2D::MapItem2D(QQuickItem* parent) : QQuickPaintedItem(parent) {
  connect(&Theme::instance(), &Theme::changed, this, [this] { update(); });
}

void MapItem2D::show(std::shared_ptr<const station::TileMap> map) {
  map_ = std::move(map);
  // Another station's map has other tiles.
  std::erase_if(pictures_, [this](const auto& picture) { return !map_->tiles.contains(picture.first); });
  update();
}

void MapItem2D::look(const Camera& camera) {
  camera_ = camera;
  update();
}

void MapItem2D::show_floor(const std::optional<Floor>& floor) {
  if (floor == floor_) return;
  floor_ = floor;
  update();
}

void MapItem2D::show_grid(const SignalGrid* grid) {
  grid_ = grid;
  update();
}

QRectF MapItem2D::seen() const {
  if (camera_.turn == 0.0) return {0, 0, width(), height()};
  const double side = std::hypot(width(), height());
  return {(width() - side) / 2, (height() - side) / 2, side, side};
}

void MapItem2D::draw_reception(QPainter& painter, const Camera& camera) const {
  constexpr std::array kOpacity{0.8, 0.8, 0.4};  // Patterns leave most of the map free.
  const QRectF view = seen();
  const Theme& theme = Theme::instance();
  const std::array brushes{QBrush(theme.of(Token::ok), Qt::Dense6Pattern),
                           QBrush(theme.of(Token::warn), Qt::BDiagPattern), QBrush(theme.of(Token::bad))};
  for (const auto& [place, cell] : grid_->cells()) {
    const Point low = camera.to_screen(place.first * SignalGrid::kCell, place.second * SignalGrid::kCell);
    const Point high =
        camera.to_screen((place.first + 1) * SignalGrid::kCell, (place.second + 1) * SignalGrid::kCell);
    const QRectF target(QPointF(std::round(low.x), std::round(high.y)),
                        QPointF(std::round(high.x), std::round(low.y)));
    if (!target.intersects(view)) continue;
    const auto step = static_cast<std::size_t>(cell.step());
    painter.setOpacity(kOpacity[step]);
    painter.fillRect(target, brushes[step]);
  }
  painter.setOpacity(1.0);
}

void MapItem2D::draw_grid(QPainter& painter, const Camera& camera) const {
  const double step = bar_length(camera.scale, 160.0);
  if (step * camera.scale < 8.0) return;
  QColor colour = Theme::instance().edge();
  colour.setAlphaF(0.35F);
  painter.setPen(QPen(colour, 1.0));
  const QRectF view = seen();
  const Point low = camera.to_map(view.left(), view.bottom()), high = camera.to_map(view.right(), view.top());
  for (double x = std::ceil(low.x / step) * step; x < high.x; x += step) {
    const double at = std::round(camera.to_screen(x, 0).x) + 0.5;
    painter.drawLine(QPointF(at, view.top()), QPointF(at, view.bottom()));
  }
  for (double y = std::ceil(low.y / step) * step; y < high.y; y += step) {
    const double at = std::round(camera.to_screen(0, y).y) + 0.5;
    painter.drawLine(QPointF(view.left(), at), QPointF(view.right(), at));
  }
}

void MapItem2D::paint(QPainter* painter) {
  const Theme& theme = Theme::instance();
  painter->fillRect(QRectF(0, 0, width(), height()), QColor::fromRgb(theme.palette().unknown));
  if (light_ != theme.light()) pictures_.clear();
  light_ = theme.light();
  pending_ = false;
  QElapsedTimer clock;
  clock.start();
  // Everything is drawn with north up, and turned by the painter.
  Camera camera = camera_;
  camera.set_turn(0.0);
  const QRectF view = seen();
  painter->save();
  painter->translate(width() / 2, height() / 2);
  painter->rotate(-camera_.turn * 180.0 / std::numbers::pi);
  painter->translate(-width() / 2, -height() / 2);
  const double side = map_ ? MapTile::kSide * map_->resolution : 0.0;
  if (side > 0.0 && side < 1e4) {
    painter->setRenderHint(QPainter::SmoothPixmapTransform, camera_.scale * map_->resolution < 1.0);
    for (const auto& [place, tile] : map_->tiles) {
      // Edges are rounded to pixels, so that neighbours leave no gap.
      const Point low = camera.to_screen(place.first * side, place.second * side);
      const Point high = camera.to_screen((place.first + 1) * side, (place.second + 1) * side);
      const QRectF target(QPointF(std::round(low.x), std::round(high.y)),
                          QPointF(std::round(high.x), std::round(low.y)));
      if (!target.intersects(view)) continue;
      Picture& picture = pictures_[place];
      if (picture.tile != tile || picture.floor != floor_) {
        // Where another floor is still shown, the next frame is soon enough.
        if (clock.elapsed() < kBudgetMs || picture.image.isNull())
          picture = {tile, image_of(*tile, map_->resolution, theme.palette(), floor_), floor_};
        else
          pending_ = true;
      }
      painter->drawImage(target, picture.image);
    }
  }
  if (grid_) draw_reception(*painter, camera);
  draw_grid(*painter, camera);
  painter->restore();
  if (pending_)
    QMetaObject::invokeMethod(
        this, [this] { update(); }, Qt::QueuedConnection);
}

}  // namespace adit::gui
