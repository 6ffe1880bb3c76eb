#include "core/findings/shelf.hpp"

#include <vector>

namespace adit::findings {
namespace {

constexpr std::size_t kBatch = 16;

}  // namespace

struct Shelf::Batch {
  std::vector<std::pair<Key, store::Bytes>> save{};
  std::vector<Key> remove{};

  Result<void> run(store::Disk& disk) const {
    for (const Key& key : remove)
      if (auto done = disk.remove(file_name(key)); !done) return done;
    for (const auto& [key, bytes] : save)
      if (auto done = disk.replace(file_name(key), bytes); !done) return done;
    return {};
  }
};

Shelf::Shelf(ShelfParams params, std::shared_ptr<store::Disk> disk, Executor& home,
             std::shared_ptr<Executor> writer, Outputs outputs)
    : params_(params),
      disk_(std::move(disk)),
      home_(home),
      writer_(std::move(writer)),
      outputs_(std::move(outputs)),
      self_(std::make_shared<Shelf*>(this)) {}

Shelf::~Shelf() { *self_ = nullptr; }

std::size_t Shelf::load() {
  if (!disk_) return 0;
  const auto names = disk_->list();
  if (!names) return 0;  // the first write tells
  std::size_t damaged = 0;
  for (const std::string& name : *names) {
    if (!is_finding_file(name)) continue;
    const auto bytes = disk_->read(name, 4096);
    auto finding = bytes && *bytes ? from_file(**bytes) : std::nullopt;
    if (finding && file_name(finding->key) == name && !full()) {
      all_.emplace(finding->key, std::move(*finding));
      continue;
    }
    ++damaged;
    (void)disk_->remove(name);  // what cannot be removed is found again at the next start
  }
  return damaged;
}

bool Shelf::put(Finding finding) {
  if (!valid(finding)) return false;
  if (all_.contains(finding.key)) return true;
  if (full()) return false;
  const Key key = finding.key;
  all_.emplace(key, std::move(finding));
  if (!disk_) {
    outputs_.kept(key);
    return true;
  }
  dropped_.erase(key);
  unsaved_.insert(key);
  write();
  return true;
}

void Shelf::drop(const Key& key) {
  if (all_.erase(key) == 0 || !disk_) return;
  unsaved_.erase(key);
  dropped_.insert(key);
  write();
}

void Shelf::write() {
  if (writing_ || (unsaved_.empty() && dropped_.empty())) return;
  writing_ = true;
  auto batch = std::make_shared<Batch>();
  for (const Key& key : dropped_)
    if (batch->remove.size() < kBatch) batch->remove.push_back(key);
  for (const Key& key : unsaved_)
    if (batch->save.size() < kBatch) batch->save.emplace_back(key, to_file(all_.at(key)));
  const auto back = [self = self_, batch](const Result<void>& result) {
    if (*self) (*self)->written(*batch, result);
  };
  if (disk_->instant()) {
    timer_ = home_.after(params_.write, [disk = disk_, batch, back] { back(batch->run(*disk)); });
  } else if (writer_) {
    writer_->post([disk = disk_, batch, back, &home = home_] {
      home.post([result = batch->run(*disk), back] { back(result); });
    });
  } else {
    auto result = std::make_shared<Result<void>>();
    home_.compute(
        params_.write, [disk = disk_, batch, result] { *result = batch->run(*disk); },
        [result, back] { back(*result); });
  }
}

void Shelf::written(const Batch& batch, const Result<void>& result) {
  writing_ = false;
  if (failed_ != !result.ok()) {
    failed_ = !result.ok();
    outputs_.failing(failed_, failed_ ? result.error().text : "findings are kept again");
  }
  if (!result) {
    timer_ = home_.after(params_.retry, [this] { write(); });
    return;
  }
  for (const Key& key : batch.remove) dropped_.erase(key);
  for (const auto& [key, bytes] : batch.save)
    if (unsaved_.erase(key) != 0) outputs_.kept(key);
  write();
}

}  // namespace adit::findings
