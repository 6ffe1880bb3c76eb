// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/photo_view.hpp"

#include <algorithm>
#include <utility>

#include "basestation/gui/bridge/photo_provider.hpp"
#include "basestation/gui/bridge/row_model.hpp"

namespace adit::gui {

using findings::PhotoPart;
using station::PhotoHere;

PhotoView::PhotoView(CommandSink& sink, const station::FoundReport& report, QObject* parent)
    : QObject(parent), report_(report), loader_(sink, this) {
  connect(&loader_, &PhotoLoader::failed, this,
          [this](const QString& id, PhotoPart part, const QString& why) {
            if (!is_open() || id != text_of(id_) || part != shown()) return;
            problem_ = why;
            emit changed();
          });
}

void PhotoView::show(int finding) {
  finding_ = static_cast<std::uint32_t>(finding);
  problem_.clear();
  refresh();
}

bool PhotoView::close() {
  if (std::exchange(finding_, 0) == 0) return false;
  emit changed();
  return true;
}

void PhotoView::try_again() {
  ++attempt_;
  problem_.clear();
  emit changed();
}

void PhotoView::refresh() {
  if (!is_open()) return;
  const auto& all = report_.findings;
  const auto item = std::ranges::find(all, finding_, &station::FoundItem::number);
  if (item == all.end() || !item->photo) {
    close();
    return;
  }
  const bool whole = item->photo->here == PhotoHere::whole;
  if (whole != whole_ || item->photo->id != id_) problem_.clear();
  id_ = item->photo->id;
  here_ = item->photo->here != PhotoHere::none;
  whole_ = whole;
  caption_ = photo_caption(*item);
  emit changed();
}

QString PhotoView::thumbnail(const station::FoundItem& item) const {
  if (!item.photo || item.photo->here == PhotoHere::none) return {};
  return photo_source(item.photo->id, PhotoPart::thumbnail, attempt_);
}

QString PhotoView::title() const { return text_of(caption_.title); }
QString PhotoView::text() const { return text_of(caption_.text); }
QString PhotoView::line() const { return text_of(caption_.line); }

QString PhotoView::state() const {
  return problem_.isEmpty() ? text_of(caption_.state) : "it cannot be shown: " + problem_;
}

PhotoPart PhotoView::shown() const { return whole_ ? PhotoPart::picture : PhotoPart::thumbnail; }

QString PhotoView::source() const {
  if (!is_open() || !here_) return {};
  return photo_source(id_, shown(), attempt_);
}

}  // namespace adit::gui
