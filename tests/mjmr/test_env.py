"""Worlds as dm_control environments."""

import numpy as np
import pytest
from absl.testing import absltest
from dm_control.viewer import runtime
from dm_env import StepType, specs, test_utils

from mjmr.env import environment
from mjmr.errors import InvalidInputError, SimulationDivergedError, TruthError, UnknownNameError
from mjmr.robots import PLATFORMS, platform_class
from mjmr.robots.facts import needed
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.sensors.camera import Camera
from mjmr.sensors.localizer import Localizer
from mjmr.simulation import Simulation
from mjmr.world import World

CORNERS = [[-2.0, -2.0, 0.7], [-2.0, 2.0, -0.7], [2.0, -2.0, 2.4], [2.0, 2.0, -2.4]]


def four_pioneers():
    world = World.rectangle(6.0, 6.0)
    robots = world.add_group(Pioneer2DX, CORNERS)
    robots.mount(Localizer(rate=20.0, latency=0.05, position_noise=0.01, loss=0.1))
    world.add_box(0.0, 1.0, 0.4, 0.4, mass=3.0)
    return world


def nearness(simulation):
    poses = simulation.truth.poses(simulation.world.groups[0])
    return -np.hypot(*poses[:, :2].T).mean()


def make(build=four_pioneers, reward=nearness, **options):
    return environment(build, reward=reward, **options)


def random_actions(env, count, seed=0):
    spec, rng = env.action_spec(), np.random.default_rng(seed)
    return rng.uniform(spec.minimum, spec.maximum, (count, *spec.shape))


def bits(env, actions):
    """Every observation, reward and coordinate of an episode, as bytes."""
    steps = [env.reset(), *(env.step(a) for a in actions)]
    told = [np.stack([s.observation[k] for s in steps]).tobytes() for k in steps[0].observation]
    rewards = np.array([s.reward for s in steps[1:]])
    return b"".join([*told, rewards.tobytes(), env.physics.data.qpos.tobytes()])


class FourPioneersTest(test_utils.EnvironmentTestMixin, absltest.TestCase):
    """dm_env's own tests of the contract, across the end of an episode."""

    def make_object_under_test(self):
        return make(time_limit=1.0, seed=3)

    def make_action_sequence(self):
        yield from random_actions(self.environment, 25)


class TwoKindsTest(FourPioneersTest):
    """The same for groups of two platforms with a camera, ended by the task."""

    def make_object_under_test(self):
        def build():
            world = four_pioneers()
            world.add_group(SoccerBot, [[0.0, 0.0, 0.0]])
            camera = Camera(width=16, height=12, rate=10.0)
            world.add_camera(camera, position=(0, 0, 6), look_at=(0, 0, 0))
            return world

        return make(build, termination=lambda s: s.time > 0.95)


def test_actions_are_the_commands_with_the_platforms_limits():
    def build():
        world = four_pioneers()
        world.add_group(SoccerBot, [[0.0, 0.0, 0.0]])
        return world

    env = make(build)
    spec = env.action_spec()
    names = [f"pioneer2dx{i}/{c}" for i in range(4) for c in ("forward", "turn")]
    names += [f"soccer_bot0/{c}" for c in ("forward", "left", "turn")]
    assert spec.name.split("\t") == names
    assert spec.maximum.tolist() == [1.6, 5.24] * 4 + [3.0, 3.0, 12.0]
    assert (spec.minimum == -spec.maximum).all()
    env.reset()
    observation = env.step(spec.maximum).observation
    assert (observation["pioneer2dx/command"] == [1.6, 5.24]).all()
    np.testing.assert_allclose(observation["soccer_bot/command"], [[4.5**0.5, 4.5**0.5, 12.0]])
    pioneers, soccer = env.physics.simulation.world.groups
    assert pioneers.clamped.tolist() == [0, 0, 0, 0]
    assert soccer.clamped.tolist() == [1]


def test_observations_have_the_sensors_shapes_types_and_bounds():
    def build():
        world = four_pioneers()
        for modality in ("rgb", "depth", "segmentation"):
            camera = Camera(width=16, height=12, modality=modality)
            world.add_camera(camera, position=(0, 0, 6), look_at=(0, 0, 0), name=modality)
        return world

    env = make(build)
    spec = env.observation_spec()
    assert spec["pioneer2dx/encoders"] == specs.Array((4, 2), np.int64, "pioneer2dx/encoders")
    assert spec["pioneer2dx/localizer"].maximum.tolist() == [np.inf, np.inf, np.pi]
    assert spec["pioneer2dx/command"].minimum.tolist() == [-1.6, -5.24]
    assert (spec["world/rgb"].shape, spec["world/rgb"].dtype) == ((12, 16, 3), np.uint8)
    assert (spec["world/rgb"].minimum, spec["world/rgb"].maximum) == (0, 255)
    assert (spec["world/depth"].minimum, spec["world/depth"].maximum) == (0.0, np.inf)
    assert spec["world/segmentation"].minimum == -1
    assert spec["world/segmentation"].maximum == 2**31 - 1
    seen = env.reset().observation
    assert list(seen) == list(spec)
    for name, value in seen.items():
        spec[name].validate(value)


def test_only_the_observations_asked_for_are_made():
    env = make(observations=["pioneer2dx/encoders"])
    assert list(env.observation_spec()) == list(env.reset().observation) == ["pioneer2dx/encoders"]
    with pytest.raises(UnknownNameError, match="valid: pioneer2dx/localizer, "):
        make(observations=["pioneer2dx/localiser"])


def test_observations_are_what_the_sensors_deliver_and_reward_is_of_the_end():
    """Against the bare loop with the episode's seed: the same bits."""
    env = make(seed=5)
    actions = random_actions(env, 20)
    env.reset()
    steps = [env.step(a) for a in actions]
    world = four_pioneers()
    robots = world.groups[0]
    seed = env.physics.simulation.streams.seed
    simulation = Simulation(world, seed=seed, control_period=0.1)
    rewards = []
    simulation.observe(lambda: rewards.append(nearness(simulation)))
    for k, _ in enumerate(simulation.ticks(2.0)):
        if k:
            seen = steps[k - 1].observation
            np.testing.assert_array_equal(seen["pioneer2dx/localizer"], robots.localizer.read())
            np.testing.assert_array_equal(seen["pioneer2dx/encoders"], robots.encoders.read())
        robots.drive(actions[k].reshape(4, 2))
    assert [s.reward for s in steps] == rewards[1:]
    assert env.physics.data.qpos.tobytes() == simulation.data.qpos.tobytes()


def test_same_seed_same_bits_and_each_episode_its_own_noise():
    actions = random_actions(make(), 20)
    episodes = []
    for seed in (7, 7, 8):
        env = make(seed=seed)
        np.random.seed(seed)  # noqa: NPY002
        episodes.append([bits(env, actions), bits(env, actions)])
        np.random.random()  # noqa: NPY002
    assert episodes[0] == episodes[1]
    assert len({episodes[0][0], episodes[0][1], episodes[2][0], episodes[2][1]}) == 4


def test_a_reset_equals_a_fresh_environment():
    """The second episode after one that was driven into walls, and after none."""
    used, fresh = make(seed=1), make(seed=1)
    bits(used, random_actions(used, 60, seed=9))
    used.physics.data.xfrc_applied[:] = 3.0
    fresh.reset()
    actions = random_actions(used, 20)
    assert bits(used, actions) == bits(fresh, actions)


@pytest.mark.parametrize("robot", PLATFORMS)
def test_every_platform_takes_random_actions_and_a_reset_equals_fresh(robot):
    def build():
        half = needed(platform_class(robot)()) + 1.0
        world = World(bounds=[-half, -half, half, half])
        world.add_group(platform_class(robot), [[0.0, 0.0, 0.0]])
        return world

    used, fresh = (make(build, seed=3) for _ in range(2))
    bits(used, random_actions(used, 20, seed=5))
    fresh.reset()
    actions = random_actions(used, 10)
    assert bits(used, actions) == bits(fresh, actions)
    spec = used.observation_spec()
    for step in (used.reset(), used.step(actions[0])):
        for name, value in step.observation.items():
            spec[name].validate(value)
    # clamp lets entries within the bounds pass one by one
    platform, action = platform_class(robot)(), used.action_spec()
    for k, bound in enumerate(action.maximum):
        alone = np.zeros((1, len(action.maximum)))
        alone[0, k] = 2.0 * bound + 1.0
        assert platform.clamp(alone)[0, k] <= bound


def test_starts_are_drawn_from_the_episodes_own_stream():
    def starts(rng):
        poses = np.array(CORNERS)
        poses[:, :2] += rng.uniform(-0.5, 0.5, (4, 2))
        return {"pioneer2dx": poses}

    def first_poses(env):
        env.reset()
        return env.physics.simulation.poses_of(env.physics.simulation.world.groups[0])

    one, two = make(starts=starts, seed=4), make(starts=starts, seed=4)
    bits(one, random_actions(one, 5))
    two.reset()
    second = first_poses(one)
    np.testing.assert_array_equal(second, first_poses(two))
    assert np.abs(second[:, :2] - np.array(CORNERS)[:, :2]).max() > 0.1
    assert np.abs(second - first_poses(one)).max() > 0.1
    apart = make(starts=lambda rng: {"pioneer2dx": np.zeros((4, 3))})
    with pytest.raises(InvalidInputError, match="pioneer2dx0"):
        apart.reset()
    with pytest.raises(InvalidInputError, match="reset the environment first"):
        apart.step(np.zeros(8))
    with pytest.raises(UnknownNameError, match="unknown group 'pioneers'; valid: pioneer2dx"):
        make(starts=lambda rng: {"pioneers": CORNERS}).reset()
    with pytest.raises(InvalidInputError, match=r"must have shape \(4, 3\)"):
        make(starts=lambda rng: {"pioneer2dx": CORNERS[:3]}).reset()
    with pytest.raises(InvalidInputError, match="outside the walls"):
        make(starts=lambda rng: {"pioneer2dx": np.add(CORNERS, 1.0)}).reset()


def test_a_bad_action_is_refused_and_the_episode_goes_on():
    env = make()
    env.reset()
    for value in (np.nan, np.inf):
        action = np.zeros(8)
        action[2] = value
        with pytest.raises(InvalidInputError, match="not for pioneer2dx1$"):
            env.step(action)
    with pytest.raises(InvalidInputError, match=r"must have shape \(8,\); got \(4, 2\)"):
        env.step(np.zeros((4, 2)))
    assert env.physics.time() == 0.0
    assert env.step(np.zeros(8)).step_type is StepType.MID


def test_a_policy_cannot_read_truth_but_the_task_can():
    env = make()
    env.reset()
    env.step(np.zeros(8))
    with pytest.raises(TruthError, match="controller"):
        nearness(env.physics.simulation)


def test_an_episode_that_diverges_is_an_error_and_the_next_step_begins_another():
    env = make()
    env.reset()
    env.physics.data.qvel[0] = 1e9
    with pytest.raises(SimulationDivergedError, match="diverged at t = 0.1"):
        env.step(np.zeros(8))
    assert env.step(np.zeros(8)).first()
    assert env.step(np.zeros(8)).step_type is StepType.MID


def test_the_task_ends_an_episode_with_discount_0_and_time_with_1():
    ended = make(termination=lambda s: s.time > 0.25)
    ended.reset()
    steps = [ended.step(np.zeros(8)) for _ in range(3)]
    assert [s.discount for s in steps] == [1.0, 1.0, 0.0]
    assert steps[-1].last()
    for period, limit, count in ((0.1, 0.7, 7), (1 / 60, 0.5, 30), (0.1, 0.25, 3)):
        env = make(control_period=period, time_limit=limit)
        env.reset()
        steps = [env.step(np.zeros(8)) for _ in range(count)]
        assert [s.last() for s in steps] == [False] * (count - 1) + [True]
        assert steps[-1].discount == 1.0


def test_a_task_must_answer_with_what_was_asked_for():
    for options, told in (
        ({"termination": lambda s: 0.0}, "True or False; got 0.0"),
        ({"reward": lambda s: np.nan}, "a reward must be finite; got nan"),
    ):
        env = make(**options)
        env.reset()
        with pytest.raises(InvalidInputError, match=told):
            env.step(np.zeros(8))
    with pytest.raises(InvalidInputError, match="a time limit must be positive"):
        make(time_limit=0.0)


def test_physics_shares_model_and_data_and_steps_by_whole_periods():
    env = make(control_period=1 / 60)
    physics = env.physics
    model, data = physics.model.ptr, physics.data.ptr
    for _ in range(2):
        env.reset()
        assert physics.simulation.model is model is physics.model.ptr
        assert physics.simulation.data is data is physics.data.ptr
    assert env.control_timestep() == pytest.approx(1 / 60, abs=1e-15)
    env.step(np.zeros(8))
    assert physics.time() == pytest.approx(1 / 60, abs=1e-12)
    assert physics.named.data.xpos["pioneer2dx0/base", "x"] == pytest.approx(-2.0)
    with pytest.raises(InvalidInputError, match="4 timesteps; got 1"):
        physics.step()
    twin = physics.copy()
    twin.step()
    assert twin.time() - physics.time() == pytest.approx(physics.timestep(), abs=1e-12)


def test_the_viewers_runtime_paces_pauses_and_restarts():
    """Without a window: frames of 1/30 s of real time, and a pause in the middle."""

    def run(frames, pause_at, policy):
        env = make(control_period=0.02, time_limit=3.0, seed=2)
        player = runtime.Runtime(env, policy)
        for k in range(frames):
            if k == pause_at:
                for _ in range(5):
                    player.tick(1 / 30, True)
            player.tick(1 / 30, False)
        return env, player

    def policy(step):
        return np.tile([0.5, 0.3], 4) * (1 + len(step.observation))

    env, player = run(60, pause_at=20, policy=policy)
    assert player.state is runtime.State.RUNNING
    # two seconds of frames; one control period is the grain
    assert player.get_time() == pytest.approx(2.0, abs=0.0201)
    straight, _ = run(60, pause_at=-1, policy=policy)
    assert straight.physics.data.qpos.tobytes() == env.physics.data.qpos.tobytes()
    before = player.get_time()
    player.single_step()
    assert player.get_time() == pytest.approx(before + 0.02, abs=1e-9)
    begun = []
    player.on_episode_begin += lambda: begun.append(player.get_time())
    player.restart()
    player.tick(1 / 30, False)
    assert begun == [0.0]
    assert 0.0 < player.get_time() < 0.05
    for _ in range(120):
        player.tick(1 / 30, False)
    assert player.state is runtime.State.STOPPED
    assert player.get_time() == pytest.approx(3.0, abs=1e-9)
    # without a policy it commands the middle of the bounds: nobody moves
    env, _ = run(10, pause_at=-1, policy=None)
    sim = env.physics.simulation
    np.testing.assert_allclose(sim.poses_of(sim.world.groups[0]), CORNERS, atol=1e-4)


def test_the_viewers_runtime_reports_a_bad_policy():
    env = make()
    player, errors = runtime.Runtime(env, lambda step: np.full(8, np.nan)), []
    player.on_error += errors.append
    for _ in range(3):
        player.tick(0.1, False)
    assert player.state is runtime.State.STOPPED
    assert "not for pioneer2dx0, pioneer2dx1, pioneer2dx2, pioneer2dx3" in errors[0]


def test_the_example_in_the_docs_runs():
    import mjmr.env

    text = mjmr.env.__doc__ or ""
    code = "\n".join(line[4:] for line in text.splitlines() if line.startswith("    "))
    assert 12 <= len(code.splitlines()) <= 20
    names = {"np": np, "policy": lambda seen: 0.2 * np.ones(8)}
    exec(code.replace("20.0", "1.0"), names)
    step = names["step"]
    assert step.last()
    assert step.reward == pytest.approx(-np.hypot(2, 2), abs=0.01)  # two near, two leave
