// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QImage>
#include <QQuickPaintedItem>
#include <map>
#include <memory>
#include <utility>

#include "basestation/gui/scene/camera.hpp"
#include "basestation/gui/scene/colours.hpp"
#include "basestation/model/map_tiles.hpp"

namespace adit::gui {

/// The picture of a tile: things brighter the higher, unknown cells transparent; north is up.
QImage image_of(const station::MapTile& tile, double resolution, const Palette& palette);

/// Draws the map from above, and a grid. It is painted by the processor, so that it looks the same without a
/// GPU.
class MapItem2D : public QQuickPaintedItem {
  Q_OBJECT

 public:
  explicit MapItem2D(QQuickItem* parent = nullptr);
  void show(std::shared_ptr<const station::TileMap> map);
  void look(const Camera& camera);
  void paint(QPainter* painter) override;

 private:
  struct Picture {
    std::shared_ptr<const station::MapTile> tile{};
    QImage image{};
  };

  void draw_grid(QPainter& painter) const;

  std::shared_ptr<const station::TileMap> map_{};
  std::map<std::pair<int, int>, Picture> pictures_{};
  bool light_{false};  ///< Theme of the pictures.
  Camera camera_{};
};

}  // namespace adit::gui
