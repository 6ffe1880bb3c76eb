// SPDX-License-Identifier: Apache-2.0
#pragma once
// Conversion of receipts to the radio contract's. Included by .cpp files only.
#include "adit/bulk.h"
#include "core/transfer/piece.hpp"

namespace adit::station {

inline radio::BulkReceipt to_radio(const std::string& robot, const transfer::Receipt& receipt) {
  radio::BulkReceipt out;
  out.robot(robot);
  out.session(receipt.session);
  out.newest(receipt.newest);
  out.received(receipt.received);
  return out;
}

}  // namespace adit::station
