// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QImage>
#include <QQuickPaintedItem>
#include <map>
#include <memory>
#include <utility>

#include "basestation/gui/scene/camera.hpp"
#include "basestation/gui/scene/colours.hpp"
#include "basestation/gui/scene/floors.hpp"
#include "basestation/gui/scene/signal_grid.hpp"
#include "basestation/model/map_tiles.hpp"

namespace adit::gui {

/// The picture of a tile: clutter and walls in hues of their own, unknown cells transparent; north is up.
/// With a floor, what is on others is a ghost.
QImage image_of(const station::MapTile& tile, double resolution, const Palette& palette,
                const std::optional<Floor>& floor = std::nullopt);

/// Draws the map from above, and a grid. It is painted by the processor, so that it looks the same without a
/// GPU.
class MapItem2D : public QQuickPaintedItem {
  Q_OBJECT

 public:
  explicit MapItem2D(QQuickItem* parent = nullptr);
  void show(std::shared_ptr<const station::TileMap> map);
  void look(const Camera& camera);
  /// Shows one floor, or all of them.
  void show_floor(const std::optional<Floor>& floor);
  /// Draws the reception above the map; null: does not. The grid stays where it is.
  void show_grid(const SignalGrid* grid);
  const SignalGrid* grid() const { return grid_; }
  /// Whether pictures wait for the next frame.
  bool pending() const { return pending_; }
  void paint(QPainter* painter) override;

 private:
  struct Picture {
    std::shared_ptr<const station::MapTile> tile{};
    QImage image{};
    std::optional<Floor> floor{};
  };

  /// The part that is in view before it is turned, pixels.
  QRectF seen() const;
  /// `camera`: with north up.
  void draw_grid(QPainter& painter, const Camera& camera) const;
  void draw_reception(QPainter& painter, const Camera& camera) const;

  std::shared_ptr<const station::TileMap> map_{};
  std::map<std::pair<int, int>, Picture> pictures_{};
  const SignalGrid* grid_{};
  std::optional<Floor> floor_{};
  bool pending_{false};
  bool light_{false};  ///< Theme of the pictures.
  Camera camera_{};
};

}  // namespace adit::gui
