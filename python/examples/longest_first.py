"""A policy of one's own: the longest body first, no push twice while nothing new is known.

    python -m grrl.experiment --object RPRPRPR --out out --policy longest_first.py:LongestFirst
"""


class LongestFirst:
    name = "longest-first"
    order = (0, 3, 2, 5, 1, 4)  # along the body, then across, then at 45 degrees

    def begin_trial(self):
        self.known, self.tried = None, set()

    def choose(self, view, random):
        bodies = view.model.bodies
        joints = {(*sorted((bodies[j.a].name, bodies[j.b].name)), j.type) for j in view.model.joints}
        known = ({body.name for body in bodies}, joints)
        if known != self.known or len(self.tried) == len(bodies) * len(self.order):
            self.known, self.tried = known, set()
        for link in sorted(range(len(bodies)), key=lambda i: -bodies[i].length):
            for direction in self.order:
                push = (bodies[link].name, direction)
                if push not in self.tried:
                    self.tried.add(push)
                    return link, direction

    def learn(self, outcome):
        """Would learn from outcome.reward; a rule does not."""
