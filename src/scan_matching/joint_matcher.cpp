// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/scan_matching/joint_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <utility>

#include "block_sums.hpp"
#include "correlative_search.hpp"
#include "lookup_table.hpp"
#include "masked_mapper/scan_matching/for_each.hpp"
#include "refine_match.hpp"

namespace masked_mapper {
namespace {

using TablePtr = std::shared_ptr<const LookupTable>;

// Half of the search window in steps. A deviation that is not a number asks for the largest window.
std::int32_t HalfWindow(double variance, double sigmas, double smallest, double largest,
                        double step) {
  const double wanted = sigmas * std::sqrt(variance);
  const double half = wanted < largest ? std::max(wanted, smallest) : largest;
  return static_cast<std::int32_t>(std::ceil(half / step - 1e-9));
}

// The tables of the scans matched last, within a budget of memory.
class TableCache {
 public:
  explicit TableCache(std::size_t budget_bytes) : budget_bytes_(budget_bytes) {}

  TablePtr Find(std::int64_t key) {
    const auto found = entries_.find(key);
    if (found == entries_.end()) return nullptr;
    order_.splice(order_.begin(), order_, found->second.place);
    return found->second.table;
  }

  bool Has(std::int64_t key) const { return entries_.count(key) != 0; }

  void Clear() {
    entries_.clear();
    order_.clear();
    bytes_ = 0;
  }

  void Insert(std::int64_t key, TablePtr table) {
    bytes_ += table->MemoryBytes();
    order_.push_front(key);
    entries_[key] = {std::move(table), order_.begin()};
    while (bytes_ > budget_bytes_) {
      const auto oldest = entries_.find(order_.back());
      bytes_ -= oldest->second.table->MemoryBytes();
      entries_.erase(oldest);
      order_.pop_back();
    }
  }

 private:
  struct Entry {
    TablePtr table;
    std::list<std::int64_t>::iterator place;
  };

  std::size_t budget_bytes_;
  std::size_t bytes_ = 0;
  std::list<std::int64_t> order_;  // most recently used first
  std::map<std::int64_t, Entry> entries_;
};

}  // namespace

SearchGrid SearchGridFor(const UncertainPose2& guess, const MatcherOptions& options) {
  SearchGrid grid;
  grid.T_reference_query_guess = guess.mean;
  grid.resolution_m = options.table.resolution_m;
  grid.angle_step = DegToRad(options.angle_step_deg);
  const auto half_m = [&](double variance) {
    return HalfWindow(variance, options.window_sigmas, options.min_window_m, options.max_window_m,
                      grid.resolution_m);
  };
  grid.half_x = half_m(guess.covariance(0, 0));
  grid.half_y = half_m(guess.covariance(1, 1));
  grid.half_angle =
      HalfWindow(guess.covariance(2, 2), options.window_sigmas, DegToRad(options.min_window_deg),
                 DegToRad(options.max_window_deg), grid.angle_step);
  return grid;
}

class JointMatcher::Impl {
 public:
  explicit Impl(const MatcherOptions& options)
      : options_(options),
        kernels_(options.table),
        tables_(options.table_memory_mib * std::size_t{1024 * 1024}) {}

  std::vector<MatchResult> Match(const std::vector<MatchPair>& pairs) {
    const std::vector<TablePtr> tables = TablesOf(pairs);
    std::map<const ScanPoints*, std::vector<Eigen::Vector2d>> thinned;
    std::vector<SearchProblem> problems;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const ScanPoints* points = pairs[i].points_in_query.get();
      const auto [query, is_new] = thinned.try_emplace(points);
      if (is_new) {
        query->second = ThinPoints(*points, options_.point_spacing_m, options_.table.max_range_m);
      }
      SearchProblem problem;
      problem.table = tables[i].get();
      problem.points_in_query = &query->second;
      problem.grid = SearchGridFor(pairs[i].T_reference_query_guess, options_);
      problem.prior_root = PriorRoot(pairs[i].T_reference_query_guess.covariance, problem.grid);
      problem.prior_weight = options_.prior_weight;
      problem.min_score = options_.min_score;
      problems.push_back(problem);
    }
    return Solve(pairs, problems);
  }

  bool Has(std::int64_t reference_key) const { return tables_.Has(reference_key); }

  void Forget() { tables_.Clear(); }

 private:
  std::vector<TablePtr> TablesOf(const std::vector<MatchPair>& pairs) {
    std::map<std::int64_t, TablePtr> needed;
    std::vector<const MatchPair*> missing;
    for (const MatchPair& pair : pairs) {
      const auto [entry, is_new] = needed.try_emplace(pair.reference_key);
      if (!is_new) continue;
      entry->second = tables_.Find(pair.reference_key);
      if (!entry->second) missing.push_back(&pair);
    }
    std::vector<TablePtr> made(missing.size());
    const int threads_of_each = missing.size() == 1 ? options_.threads : 1;
    ForEach(missing.size(), options_.threads, [&](std::size_t i) {
      made[i] = std::make_shared<const LookupTable>(*missing[i]->points_in_reference,
                                                    options_.table, kernels_, threads_of_each);
    });
    for (std::size_t i = 0; i < made.size(); ++i) {
      needed[missing[i]->reference_key] = made[i];
      tables_.Insert(missing[i]->reference_key, made[i]);
    }
    std::vector<TablePtr> tables;
    for (const MatchPair& pair : pairs) tables.push_back(needed[pair.reference_key]);
    return tables;
  }

  // Each thread searches its share of the pairs in a queue of its own; with one thread that is one
  // queue over all pairs. No pair's result depends on another's, so the shares do not matter.
  std::vector<MatchResult> Solve(const std::vector<MatchPair>& pairs,
                                 const std::vector<SearchProblem>& problems) {
    const std::size_t shares =
        std::min(problems.size(), static_cast<std::size_t>(std::max(options_.threads, 1)));
    std::vector<MatchResult> results(pairs.size());
    ForEach(shares, options_.threads, [&](std::size_t share) {
      std::vector<SearchProblem> mine;
      for (std::size_t i = share; i < problems.size(); i += shares) mine.push_back(problems[i]);
      const std::vector<SearchResult> found = SearchJointly(mine);
      for (std::size_t k = 0; k < mine.size(); ++k) {
        const std::size_t i = share + k * shares;
        results[i] = Refine(pairs[i], mine[k], found[k]);
      }
      if (options_.look_elsewhere) {
        const std::vector<SearchResult> elsewhere = SearchElsewhere(mine, found);
        for (std::size_t k = 0; k < mine.size(); ++k) {
          if (!found[k].found || !elsewhere[k].found) continue;
          results[share + k * shares].elsewhere =
              Elsewhere{PoseOf(mine[k].grid, elsewhere[k].best), elsewhere[k].score};
        }
      }
    });
    return results;
  }

  std::vector<SearchResult> SearchElsewhere(std::vector<SearchProblem> problems,
                                            const std::vector<SearchResult>& found) const {
    const auto steps = [](double distance, double step) {
      return static_cast<std::int32_t>(std::floor(distance / step + 1e-9));
    };
    for (std::size_t k = 0; k < problems.size(); ++k) {
      SearchProblem& problem = problems[k];
      const std::int32_t half_m = steps(options_.elsewhere_m, problem.grid.resolution_m);
      problem.left_out = {found[k].best,
                          steps(DegToRad(options_.elsewhere_deg), problem.grid.angle_step), half_m,
                          half_m};
      // Without a match there is nothing to compare with, and no score reaches 2.
      problem.min_score = found[k].found ? options_.elsewhere_floor * found[k].score : 2.0;
    }
    return SearchJointly(problems);
  }

  MatchResult Refine(const MatchPair& pair, const SearchProblem& problem,
                     const SearchResult& found) const {
    MatchResult result;
    result.score = found.score;
    result.T_reference_query = pair.T_reference_query_guess;
    if (!found.found) return result;
    result.outcome = MatchOutcome::kMatched;
    const RefinedMatch refined = RefineMatch(*problem.table, *problem.points_in_query,
                                             PoseOf(problem.grid, found.best), options_.refine);
    result.T_reference_query.mean = refined.T_reference_query.mean;
    result.T_reference_query.covariance = ResponseCovariance(
        *problem.table, *problem.points_in_query, refined.T_reference_query.mean, options_.refine);
    return result;
  }

  MatcherOptions options_;
  BlurKernels kernels_;
  TableCache tables_;
};

JointMatcher::JointMatcher(const MatcherOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}

JointMatcher::~JointMatcher() = default;

std::vector<MatchResult> JointMatcher::Match(const std::vector<MatchPair>& pairs) {
  return impl_->Match(pairs);
}

bool JointMatcher::Has(std::int64_t reference_key) const { return impl_->Has(reference_key); }

void JointMatcher::Forget() { impl_->Forget(); }

}  // namespace masked_mapper
