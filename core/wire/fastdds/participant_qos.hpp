// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <memory>

#include "core/result/result.hpp"
#include "core/wire/fastdds/fastdds_participant.hpp"

namespace adit::wire {

struct TransportContext;

/// Returns the transports, discovery settings and limits of a participant. Errors: bad_argument for a wrong
/// domain or address.
Result<eprosima::fastdds::dds::DomainParticipantQos> dds_participant_qos(
    const FastDdsParams& params, std::shared_ptr<TransportContext> context);

}  // namespace adit::wire
