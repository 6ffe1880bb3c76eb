// SPDX-License-Identifier: Apache-2.0
#include "sim/world/voxel_lanes.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

#include <cstddef>
#include <cstring>

#define ADIT_AVX2 [[gnu::target("avx2")]]

namespace adit::sim {
namespace {

constexpr int kWide = VoxelLanes::kWide;

ADIT_AVX2 inline __m256d widen(__m128i mask) { return _mm256_castsi256_pd(_mm256_cvtepi32_epi64(mask)); }
ADIT_AVX2 inline __m128i narrow(__m256d mask) {
  const __m256i order = _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6);
  return _mm256_castsi256_si128(_mm256_permutevar8x32_epi32(_mm256_castpd_si256(mask), order));
}
/// `value` brought between two others.
ADIT_AVX2 inline __m128i keep_lanes(__m128i value, __m128i low, __m128i high) {
  return _mm_min_epi32(_mm_max_epi32(value, low), high);
}
ADIT_AVX2 inline __m128i select(__m128i mask, __m128i yes, __m128i no) {
  return _mm_blendv_epi8(no, yes, mask);
}

/// Four rays.
struct Group {
  __m256d gx, gy;      ///< Start, in columns.
  __m256d sx, sy;      ///< Columns per metre, >= 0.
  __m256d ax, ay, az;  ///< Metres per column, metres per metre of height.
  __m256d rise, t;
  __m128i i, j, k, up, shift, direction;
  __m128i cell;          ///< Index of that cell.
  __m128i active;        ///< All bits of a ray that is under way.
  __m128i far, outside;  ///< How the others ended.
};

/// Takes down which cells the rays are in. Their strides are fetched while the other groups are under way:
/// half of the time went into waiting for them.
ADIT_AVX2 inline void enter_cells(Group& g, const VoxelLanes& lanes) {
  const __m128i row = _mm_set1_epi32(lanes.nx * lanes.layers), top = _mm_set1_epi32(lanes.layers);
  g.cell = _mm_add_epi32(_mm_add_epi32(_mm_mullo_epi32(g.j, row), _mm_mullo_epi32(g.i, top)), g.k);
  const auto fetch = [&lanes](int index) {
    _mm_prefetch(reinterpret_cast<const char*>(lanes.strides +
                                               VoxelLanes::kBytes * static_cast<std::ptrdiff_t>(index)),
                 _MM_HINT_T0);
  };
  fetch(_mm_extract_epi32(g.cell, 0));
  fetch(_mm_extract_epi32(g.cell, 1));
  fetch(_mm_extract_epi32(g.cell, 2));
  fetch(_mm_extract_epi32(g.cell, 3));
}

/// Where the divisor is 0, a border far away takes the place of the quotient.
ADIT_AVX2 inline __m256d divide(__m256d a, __m256d b) {
  const __m256d none = _mm256_cmp_pd(b, _mm256_setzero_pd(), _CMP_EQ_OQ);
  return _mm256_blendv_pd(_mm256_div_pd(a, b), _mm256_set1_pd(VoxelLanes::kFar), none);
}

ADIT_AVX2 inline void load(Group& g, const VoxelLanes& lanes, int first) {
  const __m256d dx = _mm256_load_pd(lanes.dx + first), dy = _mm256_load_pd(lanes.dy + first),
                dz = _mm256_load_pd(lanes.dz + first);
  g.gx = _mm256_set1_pd(lanes.gx);
  g.gy = _mm256_set1_pd(lanes.gy);
  g.sx = _mm256_mul_pd(dx, _mm256_set1_pd(lanes.columns_per_metre));
  g.sy = _mm256_mul_pd(dy, _mm256_set1_pd(lanes.columns_per_metre));
  g.ax = divide(_mm256_set1_pd(lanes.resolution), dx);
  g.ay = divide(_mm256_set1_pd(lanes.resolution), dy);
  g.az = divide(_mm256_set1_pd(1.0), dz);
  g.rise = _mm256_div_pd(_mm256_set1_pd(1.0), g.az);
  g.t = _mm256_setzero_pd();
  g.i = _mm_set1_epi32(lanes.i);
  g.j = _mm_set1_epi32(lanes.j);
  g.k = _mm_set1_epi32(lanes.k);
  // Upwards: 1, downwards: 0.
  g.up = _mm_add_epi32(narrow(_mm256_cmp_pd(dz, _mm256_setzero_pd(), _CMP_LT_OQ)), _mm_set1_epi32(1));
  g.shift = _mm_slli_epi32(g.up, 2);  // Layers above are in the high half of the byte.
  g.direction = _mm_sub_epi32(_mm_slli_epi32(g.up, 1), _mm_set1_epi32(1));
  const __m128i number = _mm_add_epi32(_mm_set1_epi32(first), _mm_setr_epi32(0, 1, 2, 3));
  g.active = _mm_cmpgt_epi32(_mm_set1_epi32(lanes.count), number);
  g.far = g.outside = _mm_setzero_si128();
  enter_cells(g, lanes);
}

// Four loads take less time than one gather instruction, which is slow on many processors.
ADIT_AVX2 inline __m128i strides_at(const std::uint8_t* strides, __m128i cell) {
  const auto load_one = [strides](int index) {
    std::uint32_t stride;
    std::memcpy(&stride, strides + VoxelLanes::kBytes * static_cast<std::ptrdiff_t>(index), sizeof stride);
    return static_cast<int>(stride);
  };
  return _mm_setr_epi32(load_one(_mm_extract_epi32(cell, 0)), load_one(_mm_extract_epi32(cell, 1)),
                        load_one(_mm_extract_epi32(cell, 2)), load_one(_mm_extract_epi32(cell, 3)));
}

/// Distance at which the rays cross the border of a layer, m.
ADIT_AVX2 inline __m256d border(const Group& g, const VoxelLanes& lanes, __m128i layer) {
  const __m128i at = _mm_add_epi32(layer, g.up);
  const double* const levels = lanes.levels;
  const __m256d level = _mm256_setr_pd(levels[_mm_extract_epi32(at, 0)], levels[_mm_extract_epi32(at, 1)],
                                       levels[_mm_extract_epi32(at, 2)], levels[_mm_extract_epi32(at, 3)]);
  return _mm256_mul_pd(_mm256_sub_pd(level, _mm256_set1_pd(lanes.z)), g.az);
}

ADIT_AVX2 inline __m128i min_of(__m128i a, __m128i b) { return _mm_min_epi32(a, b); }
ADIT_AVX2 inline __m128i max_of(__m128i a, __m128i b) { return _mm_max_epi32(a, b); }
/// The layer in which the rays are at a distance, where all have one thickness.
ADIT_AVX2 inline __m128i layer_at(const Group& g, const VoxelLanes& lanes, __m256d distance) {
  const __m256d height =
      _mm256_add_pd(_mm256_set1_pd(lanes.z - lanes.levels[0]), _mm256_mul_pd(distance, g.rise));
  return _mm256_cvttpd_epi32(_mm256_mul_pd(height, _mm256_set1_pd(lanes.layers_per_metre)));
}

/// One stride of each ray that is under way; false: none is.
ADIT_AVX2 inline bool stride(Group& g, const VoxelLanes& lanes) {
  const __m128i one = _mm_set1_epi32(1);
  const __m128i top = _mm_set1_epi32(lanes.layers);
  const __m128i word = strides_at(lanes.strides, g.cell);
  const __m128i width = _mm_and_si128(word, _mm_set1_epi32(0xff));
  const __m128i depth = _mm_and_si128(_mm_srli_epi32(word, 8), _mm_set1_epi32(0xff));
  const __m128i reach = _mm_and_si128(_mm_srlv_epi32(_mm_srli_epi32(word, 16), g.shift), _mm_set1_epi32(0xf));
  g.active = _mm_andnot_si128(_mm_cmpeq_epi32(width, _mm_setzero_si128()), g.active);
  if (_mm_movemask_epi8(g.active) == 0) return false;

  const __m128i next_i = _mm_add_epi32(g.i, width), next_j = _mm_add_epi32(g.j, depth);
  const __m256d tx = _mm256_mul_pd(_mm256_sub_pd(_mm256_cvtepi32_pd(next_i), g.gx), g.ax);
  const __m256d ty = _mm256_mul_pd(_mm256_sub_pd(_mm256_cvtepi32_pd(next_j), g.gy), g.ay);
  const __m256d side = _mm256_min_pd(tx, ty);
  const __m128i last = _mm_add_epi32(g.k, _mm_sign_epi32(reach, g.direction));
  const __m256d tz = border(g, lanes, last);
  const __m256d vertical_wide = _mm256_cmp_pd(tz, side, _CMP_LT_OQ);
  const __m128i vertical = narrow(vertical_wide);

  // Rays that leave the box through a side: the layer in which they do so.
  const __m128i sideways = _mm_andnot_si128(vertical, g.active);
  __m128i k = g.k;
  if (lanes.layers_per_metre > 0.0)
    k = keep_lanes(layer_at(g, lanes, side), min_of(k, last), max_of(k, last));
  // Rounding may put that off by one. Else layers differ, and are passed one by one.
  const auto before_side = [&](__m128i layer) __attribute__((target("avx2"))) {
    return narrow(_mm256_cmp_pd(border(g, lanes, layer), side, _CMP_LT_OQ));
  };
  for (__m128i more = sideways;;) {
    more = _mm_and_si128(_mm_andnot_si128(_mm_cmpeq_epi32(k, last), more), before_side(k));
    if (_mm_movemask_epi8(more) == 0) break;
    k = _mm_add_epi32(k, _mm_and_si128(more, g.direction));
  }
  for (__m128i more = sideways;;) {
    more = _mm_andnot_si128(_mm_cmpeq_epi32(k, g.k), more);
    if (_mm_movemask_epi8(more) == 0) break;
    const __m128i one_back = select(more, _mm_sub_epi32(k, g.direction), k);
    more = _mm_andnot_si128(before_side(one_back), more);
    if (_mm_movemask_epi8(more) == 0) break;
    k = select(more, one_back, k);
  }

  const __m256d t = _mm256_max_pd(_mm256_blendv_pd(side, tz, vertical_wide), g.t);
  const __m256d active_wide = widen(g.active);
  g.t = _mm256_blendv_pd(g.t, t, active_wide);
  const __m128i far = narrow(_mm256_cmp_pd(t, _mm256_set1_pd(lanes.max_range), _CMP_GE_OQ));
  g.far = _mm_or_si128(g.far, _mm_and_si128(far, g.active));
  g.active = _mm_andnot_si128(far, g.active);

  const __m128i in_i = keep_lanes(_mm256_cvttpd_epi32(_mm256_add_pd(g.gx, _mm256_mul_pd(t, g.sx))), g.i,
                                  _mm_sub_epi32(next_i, one));
  const __m128i in_j = keep_lanes(_mm256_cvttpd_epi32(_mm256_add_pd(g.gy, _mm256_mul_pd(t, g.sy))), g.j,
                                  _mm_sub_epi32(next_j, one));
  const __m128i first_x = narrow(_mm256_cmp_pd(tx, ty, _CMP_LT_OQ));
  const __m128i i = select(_mm_andnot_si128(vertical, first_x), next_i, in_i);
  const __m128i j = select(_mm_or_si128(vertical, first_x), in_j, next_j);
  k = select(vertical, _mm_add_epi32(last, g.direction), k);
  const __m128i below_or_above =
      _mm_or_si128(_mm_cmpgt_epi32(_mm_setzero_si128(), k), _mm_cmpgt_epi32(k, _mm_sub_epi32(top, one)));
  g.active = _mm_andnot_si128(below_or_above, g.active);
  const __m128i beside = _mm_or_si128(_mm_cmpgt_epi32(i, _mm_set1_epi32(lanes.nx - 1)),
                                      _mm_cmpgt_epi32(j, _mm_set1_epi32(lanes.ny - 1)));
  g.outside = _mm_or_si128(g.outside, _mm_and_si128(beside, g.active));
  g.active = _mm_andnot_si128(beside, g.active);
  // Rays that ended stay in their last cell.
  g.i = select(g.active, i, g.i);
  g.j = select(g.active, j, g.j);
  g.k = select(g.active, k, g.k);
  enter_cells(g, lanes);
  return _mm_movemask_epi8(g.active) != 0;
}

ADIT_AVX2 void follow(VoxelLanes& lanes, LaneEnd* ends) {
  constexpr int kGroups = VoxelLanes::kMax / kWide;
  Group groups[kGroups];
  const int used = (lanes.count + kWide - 1) / kWide;
  for (int n = 0; n < used; ++n) load(groups[n], lanes, n * kWide);
  // In turn: the processor works on one while another waits for the memory.
  unsigned under_way = (1u << used) - 1;
  while (under_way != 0)
    for (int n = 0; n < used; ++n)
      if ((under_way >> n & 1u) != 0 && !stride(groups[n], lanes)) under_way &= ~(1u << n);
  for (int n = 0; n < used; ++n) {
    const Group& g = groups[n];
    _mm256_store_pd(lanes.t + n * kWide, g.t);
    const int far = _mm_movemask_ps(_mm_castsi128_ps(g.far)),
              outside = _mm_movemask_ps(_mm_castsi128_ps(g.outside));
    for (int lane = 0; lane < kWide && n * kWide + lane < lanes.count; ++lane)
      ends[n * kWide + lane] = (far >> lane & 1) != 0       ? LaneEnd::far
                               : (outside >> lane & 1) != 0 ? LaneEnd::outside
                                                            : LaneEnd::met;
  }
}

}  // namespace

bool has_voxel_lanes() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}

void cast_lanes(VoxelLanes& lanes, LaneEnd* ends) { follow(lanes, ends); }

}  // namespace adit::sim

#else

namespace adit::sim {

bool has_voxel_lanes() { return false; }
void cast_lanes(VoxelLanes&, LaneEnd*) {}

}  // namespace adit::sim

#endif
