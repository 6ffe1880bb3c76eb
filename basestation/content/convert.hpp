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

inline radio::BulkDigest to_radio(const transfer::ContentDigest& digest) {
  radio::BulkDigest out;
  out.robot(digest.robot);
  out.parts(digest.parts);
  return out;
}

}  // namespace adit::station
