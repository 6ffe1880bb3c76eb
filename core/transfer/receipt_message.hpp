// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "core/transfer/piece.hpp"

namespace adit::transfer {

/// A receipt for a robot's pieces as a message. `Message`: the radio contract's BulkReceipt.
template <class Message>
Message to_message(const std::string& robot, const Receipt& receipt) {
  Message out;
  out.robot(robot);
  out.session(receipt.session);
  out.newest(receipt.newest);
  out.received(receipt.received);
  return out;
}

}  // namespace adit::transfer
