/* Spanning forests, poses from joint values, and Newton steps to close loops. */
#include "kinematics.hpp"

#include <cstddef>

namespace grrl_sim
{

namespace
{

/* Converts angle errors to lengths, so that one tolerance serves both. */
constexpr double angle_lever_m = 0.1;
constexpr double closing_tolerance_m = 1e-7;

/* Row-major and dense; mechanisms are small. */
struct Matrix {
    size_t rows = 0;
    size_t columns = 0;
    std::vector<double> entries;

    Matrix(size_t r, size_t c) : rows(r), columns(c), entries(r * c, 0.0) {}
    double &at(size_t r, size_t c) { return entries[r * columns + c]; }
    double at(size_t r, size_t c) const { return entries[r * columns + c]; }
};

size_t index(int i)
{
    return static_cast<size_t>(i);
}

/* b's pose in a's frame at a joint value. */
Pose relative_pose(const JointSpec &joint, double value)
{
    bool turns = joint.type == GRRL_REVOLUTE;
    double angle = joint.angle_rad + (turns ? value : 0.0);
    Vec2 pivot = joint.anchor_a_m;
    if (!turns)
        pivot = pivot + value * direction(joint.axis_rad);
    return {pivot - rotate(joint.anchor_b_m, angle), angle};
}

/* From a's anchor to b's, in a's frame. */
Vec2 anchor_gap(const JointSpec &joint, const Pose &a, const Pose &b)
{
    return transform(inverse(a), transform(b, joint.anchor_b_m)) - joint.anchor_a_m;
}

std::vector<double> closing_errors(const ObjectSpec &object, const Forest &forest,
                                   const std::vector<double> &values)
{
    std::vector<Pose> poses = link_poses(object, forest, values);
    std::vector<double> errors;
    for (int j : forest.closing) {
        const JointSpec &joint = object.joints[index(j)];
        const Pose &a = poses[index(joint.a)];
        const Pose &b = poses[index(joint.b)];
        Vec2 gap = anchor_gap(joint, a, b);
        if (joint.type == GRRL_REVOLUTE) {
            errors.push_back(gap.x);
            errors.push_back(gap.y);
        } else {
            errors.push_back(cross(direction(joint.axis_rad), gap));
            errors.push_back(angle_lever_m * wrap_angle(b.angle - a.angle - joint.angle_rad));
        }
    }
    return errors;
}

double squared_norm(const std::vector<double> &v)
{
    double sum = 0.0;
    for (double x : v)
        sum += x * x;
    return sum;
}

/* Subtracts the projection of a row onto each of some unit vectors. */
void subtract_span(const std::vector<std::vector<double>> &units, std::vector<double> &row)
{
    for (const std::vector<double> &unit : units) {
        double along = 0.0;
        for (size_t c = 0; c < row.size(); c++)
            along += row[c] * unit[c];
        for (size_t c = 0; c < row.size(); c++)
            row[c] -= along * unit[c];
    }
}

/* Column i: the derivative of f with respect to the forest's i-th joint value (central
 * difference). */
template <typename Function>
Matrix derivative(const Forest &forest, std::vector<double> values, size_t rows, Function f)
{
    constexpr double h = 1e-6;
    Matrix jacobian(rows, forest.tree.size());
    for (size_t i = 0; i < forest.tree.size(); i++) {
        double &value = values[index(forest.tree[i])];
        double kept = value;
        value = kept + h;
        std::vector<double> above = f(values);
        value = kept - h;
        std::vector<double> below = f(values);
        value = kept;
        for (size_t r = 0; r < rows; r++)
            jacobian.at(r, i) = (above[r] - below[r]) / (2.0 * h);
    }
    return jacobian;
}

/* Solves (J^T J + damping I) x = -J^T e by Cholesky; the damping makes the matrix positive
 * definite. */
std::vector<double> damped_step(const Matrix &jacobian, const std::vector<double> &errors,
                                double damping)
{
    size_t n = jacobian.columns;
    Matrix a(n, n);
    std::vector<double> x(n, 0.0);
    for (size_t i = 0; i < n; i++) {
        for (size_t r = 0; r < jacobian.rows; r++)
            x[i] -= jacobian.at(r, i) * errors[r];
        for (size_t k = 0; k <= i; k++) {
            double sum = i == k ? damping : 0.0;
            for (size_t r = 0; r < jacobian.rows; r++)
                sum += jacobian.at(r, i) * jacobian.at(r, k);
            for (size_t m = 0; m < k; m++)
                sum -= a.at(i, m) * a.at(k, m);
            a.at(i, k) = i == k ? std::sqrt(std::max(sum, 1e-18)) : sum / a.at(k, k);
        }
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t m = 0; m < i; m++)
            x[i] -= a.at(i, m) * x[m];
        x[i] /= a.at(i, i);
    }
    for (size_t i = n; i-- > 0;) {
        for (size_t m = i + 1; m < n; m++)
            x[i] -= a.at(m, i) * x[m];
        x[i] /= a.at(i, i);
    }
    return x;
}

std::vector<double> all_values(const ObjectSpec &object, const Forest &forest,
                               std::vector<double> values)
{
    std::vector<Pose> poses = link_poses(object, forest, values);
    for (int j : forest.closing) {
        const JointSpec &joint = object.joints[index(j)];
        values[index(j)] = joint_value(joint, poses[index(joint.a)], poses[index(joint.b)]);
    }
    return values;
}

/* Makes the rows orthonormal; drops those that depend on earlier ones. */
std::vector<std::vector<double>> orthonormal_rows(const Matrix &matrix)
{
    std::vector<std::vector<double>> basis;
    for (size_t r = 0; r < matrix.rows; r++) {
        std::vector<double> row(matrix.columns);
        for (size_t c = 0; c < matrix.columns; c++)
            row[c] = matrix.at(r, c);
        double before = std::sqrt(squared_norm(row));
        for (int pass = 0; pass < 2; pass++) /* twice is enough (Kahan) */
            subtract_span(basis, row);
        double norm = std::sqrt(squared_norm(row));
        if (before < 1e-9 || norm < 1e-6 * before)
            continue;
        for (double &x : row)
            x /= norm;
        basis.push_back(row);
    }
    return basis;
}

} // namespace

Forest spanning_forest(const ObjectSpec &object)
{
    size_t n = object.links.size();
    Forest forest;
    forest.component.assign(n, -1);
    std::vector<bool> used(object.joints.size(), false);
    std::vector<int> order; /* fixed links first, so that they become the roots */
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < n; i++)
            if (object.links[i].fixed == (pass == 0))
                order.push_back(static_cast<int>(i));
    for (int root : order) {
        if (forest.component[index(root)] >= 0)
            continue;
        int component = static_cast<int>(forest.roots.size());
        forest.roots.push_back(root);
        forest.component[index(root)] = component;
        bool grown = true;
        while (grown) {
            grown = false;
            for (size_t j = 0; j < object.joints.size(); j++) {
                const JointSpec &joint = object.joints[j];
                bool has_a = forest.component[index(joint.a)] == component;
                bool has_b = forest.component[index(joint.b)] == component;
                if (used[j] || has_a == has_b)
                    continue;
                forest.component[index(has_a ? joint.b : joint.a)] = component;
                forest.tree.push_back(static_cast<int>(j));
                forest.from_a.push_back(has_a);
                used[j] = true;
                grown = true;
            }
        }
    }
    for (size_t j = 0; j < used.size(); j++)
        if (!used[j])
            forest.closing.push_back(static_cast<int>(j));
    return forest;
}

std::vector<Pose> link_poses(const ObjectSpec &object, const Forest &forest,
                             const std::vector<double> &values)
{
    std::vector<Pose> poses(object.links.size());
    for (size_t i = 0; i < forest.tree.size(); i++) {
        const JointSpec &joint = object.joints[index(forest.tree[i])];
        Pose relative = relative_pose(joint, values[index(forest.tree[i])]);
        if (forest.from_a[i])
            poses[index(joint.b)] = compose(poses[index(joint.a)], relative);
        else
            poses[index(joint.a)] = compose(poses[index(joint.b)], inverse(relative));
    }
    return poses;
}

double joint_value(const JointSpec &joint, const Pose &a, const Pose &b)
{
    if (joint.type == GRRL_REVOLUTE)
        return wrap_angle(b.angle - a.angle - joint.angle_rad);
    return dot(direction(joint.axis_rad), anchor_gap(joint, a, b));
}

bool close_loops(const ObjectSpec &object, const Forest &forest, std::vector<double> &values)
{
    auto errors_of = [&](const std::vector<double> &v) {
        return closing_errors(object, forest, v);
    };
    std::vector<double> errors = errors_of(values);
    double damping = 1e-4;
    for (int iteration = 0; iteration < 100; iteration++) {
        if (squared_norm(errors) < closing_tolerance_m * closing_tolerance_m) {
            values = all_values(object, forest, values);
            return true;
        }
        Matrix jacobian = derivative(forest, values, errors.size(), errors_of);
        std::vector<double> step = damped_step(jacobian, errors, damping);
        std::vector<double> next = values;
        for (size_t i = 0; i < step.size(); i++)
            next[index(forest.tree[i])] += step[i];
        std::vector<double> next_errors = errors_of(next);
        if (squared_norm(next_errors) < squared_norm(errors)) {
            values = next;
            errors = next_errors;
            damping = std::max(damping * 0.3, 1e-12);
        } else {
            damping = std::min(damping * 4.0, 1e6);
        }
    }
    return false;
}

std::vector<bool> movable_joints(const ObjectSpec &object, const Forest &forest,
                                 const std::vector<double> &values)
{
    size_t rows = 2 * forest.closing.size();
    auto errors_of = [&](const std::vector<double> &v) {
        return closing_errors(object, forest, v);
    };
    auto values_of = [&](const std::vector<double> &v) { return all_values(object, forest, v); };
    auto constraints = orthonormal_rows(derivative(forest, values, rows, errors_of));
    Matrix motion = derivative(forest, values, object.joints.size(), values_of);
    std::vector<bool> movable(object.joints.size());
    for (size_t j = 0; j < object.joints.size(); j++) {
        /* A motion that keeps the loops closed is orthogonal to every constraint. The joint moves
         * in some such motion unless its row lies in their span. */
        std::vector<double> row(motion.columns);
        for (size_t c = 0; c < row.size(); c++)
            row[c] = motion.at(j, c);
        double before = std::sqrt(squared_norm(row));
        subtract_span(constraints, row);
        movable[j] = before > 1e-9 && std::sqrt(squared_norm(row)) > 1e-4 * before;
    }
    return movable;
}

bool links_overlap(const ObjectSpec &object, const std::vector<Pose> &poses, double margin_m)
{
    for (size_t i = 0; i < object.links.size(); i++) {
        for (size_t k = i + 1; k < object.links.size(); k++) {
            bool joined = grrl_graph_joint(&object.truth, static_cast<uint8_t>(i),
                                           static_cast<uint8_t>(k)) != GRRL_NO_JOINT;
            if (joined || object.links[i].fixed || object.links[k].fixed)
                continue;
            if (overlap(link_rectangle(object.links[i], poses[i]),
                        link_rectangle(object.links[k], poses[k]), margin_m))
                return true;
        }
    }
    return false;
}

Rectangle link_rectangle(const LinkSpec &link, const Pose &pose)
{
    return {pose, link.half_length_m, link.half_width_m};
}

} // namespace grrl_sim
