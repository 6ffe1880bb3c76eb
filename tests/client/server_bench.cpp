// SPDX-License-Identifier: Apache-2.0
#include "tests/client/server_bench.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <future>

#include "basestation/client/paths.hpp"

namespace adit::station::host {

ServerBench::ServerBench(Duration grace) : grace_(grace) {
  EXPECT_EQ(::pipe(never_.data()), 0);
  ::setenv("XDG_RUNTIME_DIR", folder_.c_str(), 1);
  start_station();
}

ServerBench::~ServerBench() {
  end_station();
  for (const int fd : never_) ::close(fd);
}

void ServerBench::start_station() {
  server_ = Server::open(client::runtime_folder().value(), "op1").value();
  on_strand([this] {
    station_ = std::make_unique<Station>(
        StationParams{.name = "op1", .id = {1}, .discovery_grace = grace_, .settle = Duration{}}, *strand_,
        *wire_);
    station_->on_notice = [this](const StoredNotice& notice) {
      server_->notify(described(notice, notice.at));
    };
    station_->on_changed = [this] { server_->changed(*station_); };
    EXPECT_TRUE(station_->start().ok());
  });
  thread_ = std::thread([this] {
    server_->serve(*station_, *strand_,
                   {{"station", "op1"}, {"domain", 78}, {"remark", std::string(10000, 'x')}}, never_[0]);
  });
}

void ServerBench::end_station() {
  if (!server_) return;
  server_->end();
  thread_.join();
  on_strand([this] { station_.reset(); });
  server_.reset();
}

void ServerBench::on_strand(const std::function<void()>& work) {
  std::promise<void> done;
  strand_->post([&] {
    work();
    done.set_value();
  });
  done.get_future().wait();
}

}  // namespace adit::station::host
