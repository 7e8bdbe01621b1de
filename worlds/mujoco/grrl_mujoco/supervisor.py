"""Whether an estimated structure is the true one: isomorphic links and joints, sizes ignored."""

MAX_STEPS = 200_000


class Undecided(Exception):
    """The search budget ran out: the structures are too symmetric."""


def _adjacency(n, joints):
    """joined[i][k]: the type of the joint between links i and k. None for no structure."""
    joined = [{} for _ in range(n)]
    for kind, a, b in joints:
        if a == b or b in joined[a]:
            return None
        joined[a][b] = kind
        joined[b][a] = kind
    return joined


def _refine(left, right):
    """Colours of the links of both graphs; equal colours for links with the same neighbourhood."""
    colours = [[0] * len(left), [0] * len(right)]
    for _ in range(len(left)):
        names = {}
        colours = [
            [
                names.setdefault(
                    (old[i], tuple(sorted((kind, old[k]) for k, kind in joined[i].items()))),
                    len(names),
                )
                for i in range(len(joined))
            ]
            for old, joined in zip(colours, (left, right))
        ]
    return colours


def same_structure(n_a, joints_a, n_b, joints_b) -> bool:
    """Isomorphism of two structures given as a number of links and joints (type, a, b).

    Colour refinement, then a search with backtracking that maps links in an order in which each
    has a mapped neighbour if it can. Raises Undecided after MAX_STEPS.
    """
    if n_a != n_b or len(joints_a) != len(joints_b):
        return False
    left, right = _adjacency(n_a, joints_a), _adjacency(n_b, joints_b)
    if left is None or right is None:
        return False
    colour_a, colour_b = _refine(left, right)
    if sorted(colour_a) != sorted(colour_b):
        return False
    order, seen = [], set()
    for root in range(n_a):
        queue = [root]
        while queue:
            i = queue.pop(0)
            if i not in seen:
                seen.add(i)
                order.append(i)
                queue.extend(left[i])
    image, used = {}, set()
    steps = 0

    def extend(position):
        nonlocal steps
        if position == n_a:
            return True
        i = order[position]
        for k in range(n_b):
            steps += 1
            if steps > MAX_STEPS:
                raise Undecided
            if k in used or colour_a[i] != colour_b[k]:
                continue
            if any(m in image and right[k].get(image[m]) != kind for m, kind in left[i].items()):
                continue
            image[i] = k
            used.add(k)
            if extend(position + 1):
                return True
            del image[i]
            used.discard(k)
        return False

    return extend(0)


class Supervisor:
    """Knows the true links and joints of an object; the background is not a link."""

    def __init__(self, n_links, joints):
        self.n_links = n_links
        self.joints = list(joints)

    def correct(self, model) -> bool:
        """Whether a model_t has the true structure. Undecided counts as no."""
        believed = [
            ("P" if kind == model.PRISMATIC else "R", a, b)
            for kind, a, b in zip(model.joint_type, model.joint_a, model.joint_b)
        ]
        try:
            return same_structure(self.n_links, self.joints, model.n_links, believed)
        except Undecided:
            return False
