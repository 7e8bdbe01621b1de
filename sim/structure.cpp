/* The graph of an object, and of a model message. */
#include "structure.hpp"

namespace grrl_sim
{

grrl_graph visible_structure(const ObjectSpec &object)
{
    grrl_graph visible;
    grrl_graph_clear(&visible);
    std::vector<int> vertex(object.links.size(), -1);
    for (size_t i = 0; i < object.links.size(); i++) {
        uint8_t index = 0;
        if (!object.links[i].fixed &&
            grrl_graph_add_link(&visible, object.truth.label[i], &index) == GRRL_OK)
            vertex[i] = index;
    }
    for (const JointSpec &joint : object.joints) {
        int a = vertex[static_cast<size_t>(joint.a)];
        int b = vertex[static_cast<size_t>(joint.b)];
        if (a >= 0 && b >= 0)
            (void)!grrl_graph_add_joint(&visible, static_cast<uint8_t>(a), static_cast<uint8_t>(b),
                                        joint.type);
    }
    return visible;
}

bool structure_of(const grrl_model_t &model, grrl_graph &graph)
{
    grrl_graph_clear(&graph);
    for (int32_t i = 0; i < model.n_links; i++) {
        uint8_t index;
        if (grrl_graph_add_link(&graph, 0, &index) != GRRL_OK)
            return false;
    }
    for (int32_t i = 0; i < model.n_joints; i++)
        if (grrl_graph_add_joint(&graph, static_cast<uint8_t>(model.joint_a[i]),
                                 static_cast<uint8_t>(model.joint_b[i]),
                                 static_cast<grrl_joint_type>(model.joint_type[i])) != GRRL_OK)
            return false;
    return true;
}

} // namespace grrl_sim
