/* rule.cpp: pushes the longest body first and repeats no push. */
#include "rule.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace grrl_experiment
{

namespace
{

/* Indices into grrl_direction_deg: 0, 180, 90, 270, 45, 225 degrees. */
constexpr uint8_t order[GRRL_DIRECTIONS] = {0, 3, 2, 5, 1, 4};

class Rule : public Chooser
{
public:
    void begin_trial() override { tried_.clear(); }
    Action choose(const grrl_model &model) override;

private:
    Tried tried_;
};

Action Rule::choose(const grrl_model &model)
{
    tried_.update(model);
    std::vector<int> bodies(model.n_bodies);
    std::iota(bodies.begin(), bodies.end(), 0);
    std::stable_sort(bodies.begin(), bodies.end(), [&model](int a, int b) {
        return model.body[a].length_m > model.body[b].length_m;
    });
    for (int body : bodies) {
        for (uint8_t direction : order) {
            Action action{model.body[body].number, direction};
            if (!tried_.has(action)) {
                tried_.add(action);
                return action;
            }
        }
    }
    return {model.body[bodies[0]].number, order[0]}; /* unreachable: one push was left */
}

} // namespace

std::unique_ptr<Chooser> make_rule()
{
    return std::make_unique<Rule>();
}

} // namespace grrl_experiment
