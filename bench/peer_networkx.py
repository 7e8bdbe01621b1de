"""NetworkX behind pipes: reads cases from stdin and answers with times measured in this process.

A case is a line `kind pairs` (kind: iso or mono), then two lines per pair, the pattern and the
target: links, their labels, joints, and two ends and a type for each joint. The answer is one line:
the mean times of a query and of building both graphs in nanoseconds, then 0 or 1 for each pair.
"""
import sys
import time

import networkx
from networkx.algorithms import isomorphism

SAME_LINK = isomorphism.categorical_node_match("label", None)
SAME_JOINT = isomorphism.categorical_edge_match("type", None)


def build(numbers):
    n = numbers[0]
    graph = networkx.Graph()
    for link, label in enumerate(numbers[1 : n + 1]):
        graph.add_node(link, label=label)
    joints = numbers[n + 2 :]
    for at in range(0, len(joints), 3):
        graph.add_edge(joints[at], joints[at + 1], type=joints[at + 2])
    return graph


def match(kind, pattern, target):
    matcher = isomorphism.GraphMatcher(target, pattern, SAME_LINK, SAME_JOINT)
    if kind == "iso":
        return matcher.is_isomorphic()
    return matcher.subgraph_is_monomorphic()


def main():
    for line in sys.stdin:
        kind, n_pairs = line.split()
        described = [
            [[int(word) for word in sys.stdin.readline().split()] for _ in range(2)]
            for _ in range(int(n_pairs))
        ]
        start = time.thread_time_ns()
        pairs = [(build(pattern), build(target)) for pattern, target in described]
        built = time.thread_time_ns() - start
        start = time.thread_time_ns()
        answers = [match(kind, pattern, target) for pattern, target in pairs]
        spent = time.thread_time_ns() - start
        words = [spent / len(pairs), built / len(pairs)]
        print(*words, *(int(answer) for answer in answers), flush=True)


main()
