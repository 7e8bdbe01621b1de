/*
 * Uses the library from C++, without a wrapper around its headers and without the C++ library,
 * which a compiler for a microcontroller may lack: terms, a graph, one frame of points.
 */
#include <stdio.h>
#include <string.h>

#include <grrl/grrl.h>

namespace
{

bool reads_a_term()
{
    static grrl_term_node nodes[32];
    static grrl_term_store store;
    grrl_term_store_init(&store, nodes, 32);
    const char *text = "R(l1, P(l2, l3))";
    grrl_term term = 0;
    grrl_term_error error = {};
    grrl_graph graph = {};
    grrl_graph_clear(&graph);
    grrl_name names[GRRL_MAX_LINKS];
    return grrl_term_parse(&store, text, strlen(text), &term, &error) == GRRL_OK &&
           grrl_graph_from_term(&store, term, &graph, names, nullptr, nullptr, &error) == GRRL_OK &&
           grrl_graph_joint_count(&graph) == 2;
}

bool sees_a_frame()
{
    static grrl_perception perception;
    grrl_perception_config config = {};
    grrl_perception_config_default(&config);
    if (grrl_perception_init(&perception, &config) != GRRL_OK)
        return false;
    const int32_t id[] = {1, 2};
    const float x[] = {0.0f, 0.1f};
    const float y[] = {0.0f, 0.0f};
    const grrl_frame frame = {2, id, x, y};
    grrl_perception_observe(&perception, &frame, false);
    return perception.counts.features_high == 2;
}

} // namespace

int main()
{
    if (!reads_a_term() || !sees_a_frame())
        return 1;
    (void)printf("%d links\n", GRRL_MAX_LINKS);
    return 0;
}
