// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

StageSeconds& StageSeconds::operator+=(const StageSeconds& more) {
  for (double StageSeconds::*part :
       {&StageSeconds::read, &StageSeconds::motion, &StageSeconds::mask, &StageSeconds::projection,
        &StageSeconds::matching, &StageSeconds::validation, &StageSeconds::optimisation,
        &StageSeconds::rendering, &StageSeconds::export_, &StageSeconds::total}) {
    this->*part += more.*part;
  }
  return *this;
}

}  // namespace masked_mapper
