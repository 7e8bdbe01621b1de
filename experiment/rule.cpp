/* rule.cpp: pushes the longest body first and repeats no push. */
#include "rule.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace grrl_experiment
{

namespace
{

/* An index into grrl_direction_deg: 0, 45 or 90 degrees. Three further on is the opposite one. */
uint8_t direction_of(char way)
{
    if (way == 'a')
        return 0;
    return way == 'p' ? uint8_t{2} : uint8_t{1};
}

class Rule : public Chooser
{
public:
    explicit Rule(const std::string &order)
    {
        for (char way : order)
            for (int opposite : {0, 3})
                order_.push_back(static_cast<uint8_t>(direction_of(way) + opposite));
    }
    void begin_trial() override { tried_.clear(); }
    Action choose(const grrl_model &model) override;

private:
    std::vector<uint8_t> order_;
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
        for (uint8_t direction : order_) {
            Action action{model.body[body].number, direction};
            if (!tried_.has(action)) {
                tried_.add(action);
                return action;
            }
        }
    }
    return {model.body[bodies[0]].number, order_[0]}; /* unreachable: one push was left */
}

} // namespace

std::unique_ptr<Chooser> make_rule(const std::string &order)
{
    return std::make_unique<Rule>(order);
}

} // namespace grrl_experiment
