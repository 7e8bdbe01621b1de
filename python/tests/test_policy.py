"""Policies of Python are called as those in C are, and can do no harm."""

import gc
import pathlib
import subprocess
import sys
import weakref

import pytest
from conftest import ROOT, run

import grrl
from grrl import experiment


class Random:
    """Any push, as the library's own."""

    def choose(self, view, random):
        return divmod(random.below(view.n_links * 6), 6)


def test_same_random_numbers_as_in_c():
    for trial in (1, 2):
        mine = grrl.run_trial(grrl.Learner(Random(), seed=3), "RPR", trial)
        assert mine == grrl.run_trial(grrl.Learner("random", seed=3), "RPR", trial)


class Notes:
    """Keeps all it is told."""

    def __init__(self):
        self.told = []

    def begin_trial(self):
        self.told.append("begin")

    def choose(self, view, random):
        self.told.append(view.model.term)
        return 0, random.below(6)

    def explain(self, view, link, direction):
        return 0.5

    def learn(self, outcome):
        self.told.append(outcome)
        return 2 * outcome.reward

    def save(self):
        return repr(len(self.told)).encode()

    def load(self, store):
        self.told = ["loaded"] * int(store)


def test_callbacks():
    notes = Notes()
    learner = grrl.Learner(notes, seed=3)
    assert notes.told == ["begin"]
    result = grrl.run_trial(learner, "RR", cap=30)
    assert notes.told[1] == "begin"
    outcomes = [x for x in notes.told if isinstance(x, grrl.Outcome)]
    assert [x.reward for x in outcomes] == result.rewards
    assert [x.ended for x in outcomes] == [False] * (len(outcomes) - 1) + [result.discovered]
    assert [(x.body, x.direction) for x in outcomes] == result.actions
    assert learner.learns
    other = grrl.Learner(Notes())
    other.from_bytes(learner.to_bytes())
    assert other.to_bytes() == learner.to_bytes()
    with pytest.raises(ValueError, match="no store of a policy of Python"):
        other.from_bytes(b"else")
    with pytest.raises(ValueError, match="does not learn"):
        grrl.Learner(Random()).to_bytes()


def test_what_explain_and_learn_say_counts():
    learner, world = grrl.Learner(Notes()), grrl.World("RR")
    learner.begin_trial(1)
    for _ in range(10):
        learner.observe(world.observe())
    learner.perceive()
    decision = learner.choose()
    assert (decision.value, decision.reason) == (0.5, "rule")
    for frame in world.push(decision.push)[1]:
        learner.observe(frame, pushing=True)
    learner.perceive()
    update = learner.learn(True)
    assert update.target == 2 * update.reward > 0


class Answers:
    def __init__(self, answer):
        self.answer = answer

    def choose(self, view, random):
        if self.answer is KeyError:
            raise KeyError("mine")
        return self.answer


@pytest.mark.parametrize("answer,error,words", [
    (None, TypeError, r"must return \(link, direction\)"),
    (7, TypeError, r"must return \(link, direction\)"),
    ((1, 2, 3), TypeError, r"must return \(link, direction\)"),
    ((0.5, 2), TypeError, "whole number"),
    ((99, 0), ValueError, "link of choose is 99"),
    ((-1, 0), ValueError, "link of choose is -1"),
    ((0, 6), ValueError, "direction of choose is 6"),
    (KeyError, KeyError, "mine"),
])
def test_bad_answers(answer, error, words):
    learner = grrl.Learner(Answers(answer))
    for _ in range(2):  # and the learner is as good as new
        with pytest.raises(error, match=words):
            grrl.run_trial(learner, "RR")


def test_exceptions_of_other_callbacks():
    class Fails(Notes):
        def learn(self, outcome):
            raise OSError("no disk")

    with pytest.raises(OSError, match="no disk"):
        grrl.run_trial(grrl.Learner(Fails()), "RR")

    class FailsAtOnce(Notes):
        def begin_trial(self):
            raise OSError("no disk")

    with pytest.raises(OSError, match="no disk"):
        grrl.Learner(FailsAtOnce())

    class SaysNonsense(Notes):
        def learn(self, outcome):
            return float("nan")

    with pytest.raises(ValueError, match="target of learn is nan"):
        grrl.run_trial(grrl.Learner(SaysNonsense()), "RR")


def test_a_policy_may_not_call_its_learner():
    class Calls(Notes):
        def choose(self, view, random):
            self.learner.begin_trial(2)
            return 0, 0

    policy = Calls()
    policy.learner = grrl.Learner(policy)
    with pytest.raises(RuntimeError, match="may not call the learner"):
        grrl.run_trial(policy.learner, "RR")


def test_a_policy_that_knows_its_learner_is_freed():
    policy = Notes()
    policy.learner = grrl.Learner(policy)
    gone = weakref.ref(policy)
    del policy
    gc.collect()
    assert gone() is None


def test_the_example_is_the_rule_of_the_program(tmp_path):
    example = ROOT / "python" / "examples" / "longest_first.py"
    given = ["--object", "RPRPR", "--experiments", "2", "--trials", "3", "--seed", "4", "--pretrain",
             "RPR:2", "--policy"]
    run("EXPERIMENT", *given, "learn,paper,rule", "--out", tmp_path / "c")
    status = experiment.main([*given, f"learn,paper,{example}:LongestFirst", "--jobs", "2",
                              "--out", str(tmp_path / "python")])
    assert status == 0
    ours = (tmp_path / "python" / "trials.csv").read_text(encoding="utf-8")
    theirs = (tmp_path / "c" / "trials.csv").read_text(encoding="utf-8")
    assert ours.replace("longest-first", "rule") == theirs
    assert len(example.read_text(encoding="utf-8").splitlines()) <= 35


def command(*arguments):
    return subprocess.run([sys.executable, "-m", "grrl.experiment", *map(str, arguments)],
                          capture_output=True, text=True, check=False, timeout=120)


def test_command_line(tmp_path):
    done = command("--object", "RR", "--experiments", 1, "--trials", 2, "--out", tmp_path, "--jobs", 1)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == str(tmp_path / "trials.csv")
    assert done.stdout.startswith("RR learn: pushes trial 1 ")
    assert command("--help").returncode == 0
    blocked = tmp_path / "file"
    blocked.write_text("", encoding="utf-8")
    done = command("--object", "RR", "--out", blocked / "x", "--trials", 1)
    assert done.returncode == 1 and "file" in done.stderr


@pytest.mark.parametrize("given,words", [
    (["--object", "RXR"], "X"),
    (["--object", "RR", "--policy", "best"], "FILE.py:CLASS"),
    (["--object", "RR", "--policy", "no.py:Class"], "no.py"),
    (["--object", "RR", "--policy", "math:Class"], "Class"),
    (["--object", "RR", "--trials", "0"], "from 1 to 10000"),
    (["--object", "RR", "--noise", "nan"], "from 0 to 100"),
    (["--object", "RR", "--pretrain", "RR"], "OBJECT:N"),
    ([], "--object"),
])
def test_wrong_command_lines(tmp_path, capsys, given, words):
    with pytest.raises(SystemExit) as ended:
        experiment.main([*given, "--out", str(tmp_path)])
    assert ended.value.code == 2
    assert words in capsys.readouterr().err
    assert not pathlib.Path(tmp_path / "trials.csv").exists()
