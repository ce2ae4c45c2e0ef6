"""Seven scenarios of the catalogue, written in Python. Their worlds and traces are the same as in Rust, which a test checks.

    paracosm-fuzz scenarios.py:cut-in --driver aeb --budget 100
"""

import math

import paracosm as pc

LANE = 3.5
"""The width of a lane in metres."""

EGO_LENGTH = 4.508
"""The length of the car under test in metres: a BMW 320i."""

LENGTHS = {"car": 4.5, "van": 5.986, "truck": 10.1, "bus": 12.135, "motorcycle": 2.08}


def middles(gap: float, vehicle: str = "car") -> float:
    """Returns the distance between the middles of two vehicles whose bumpers are `gap` metres apart."""
    return gap + 0.5 * EGO_LENGTH + 0.5 * LENGTHS[vehicle]


def weather(s: pc.Scenario, friction: pc.Stream | None = None, *, later: bool = False) -> pc.Environment:
    """Asks for the weather: closed parameters, which a study can open."""
    fog = s.nominal("fog", 0.0, 1.0, 0.0, atmospheric=True, incidental=later)
    light = s.nominal("light", 0.0, 1.0, 1.0, atmospheric=True, incidental=later)
    rain = s.nominal("rain", 0.0, 1.0, 0.0, atmospheric=True, incidental=later)
    elevation = s.nominal("sun_elevation", 0.0, 90.0, math.degrees(0.9), unit="deg", atmospheric=True, incidental=True)
    azimuth = s.nominal("sun_azimuth", -180.0, 180.0, math.degrees(2.3), unit="deg", atmospheric=True, incidental=True)
    sun = (elevation * (math.pi / 180.0), azimuth * (math.pi / 180.0))
    return pc.Environment(light=light, fog=fog, rain=rain, sun=sun, friction=friction)


def roadside(s: pc.Scenario) -> None:
    """Fills the roadside, if a study asks for it."""
    s.place(pc.Roadside(s.nominal("roadside", 0.0, 1.0, 0.0, incidental=True).value()))


@pc.scenario
def pedestrian_crossing(s: pc.Scenario) -> None:
    """a pedestrian crosses the road when the ego vehicle is nearer than a distance"""
    speed = s.interval("speed", 0.5, 10.0, unit="m/s", default=1.4, plausible=(0.5, 2.8))
    distance = s.interval("distance", 5.0, 60.0, unit="m", default=30.0)
    friction = s.nominal("friction", 0.2, 0.8, 0.8)
    approach = s.nominal("approach_speed", 5.0, 30.0, 60.0 / 3.6, unit="m/s")
    lanes = s.nominal_choice("lanes", [2, 4, 6], 2)
    environment = weather(s)
    zebra = s.nominal_choice("zebra", [0, 1], 0, incidental=True)
    side = s.nominal_choice("side", ["far", "near"], "far")
    acceleration = s.nominal("acceleration", 0.5, 1000.0, 1000.0, opens=(0.96, 1.65), unit="m/s²")

    s.place(environment)
    road = pc.RoadSegment(800.0).lanes(lanes.value()).friction(friction)
    if zebra.value() == 1:
        road = road.zebra(100.0)
    placed = s.place(road)
    car = s.place(pc.AutonomousVehicle(placed.on_lane(1, 10.0)).speed(approach.value()))
    far = side.value() == "far"
    start = placed.on_sidewalk("left" if far else "right", 100.0)
    walker = s.place(pc.Pedestrian(start).accelerating(acceleration.value()))

    near = car.gap_along(placed.crossing(100.0)) < distance
    end = placed.on_sidewalk("right" if far else "left", 100.0)
    walker.walk(end, speed).skip_until(near).take_until(walker.arrived())
    roadside(s)

    s.duration(25.0)
    s.premise(near)
    s.require(
        "no-collision",
        pc.never(car.collides()),
        text="The car touches nobody. The robustness is the least clearance in metres, or minus the missing braking distance.",
        unit="m",
        scale=5.0,
    )
    s.require(
        "progress",
        pc.eventually(car.travelled() >= 100.0),
        text="The car drives at least 100 m, so that standing still for ever does not pass.",
        unit="m",
        scale=50.0,
    )


@pc.scenario
def follow_leader(s: pc.Scenario) -> None:
    """the ego vehicle follows a leader whose speed varies over the run"""
    leader_speed = s.interval("leader_speed", 0.0, 20.0, unit="m/s", signal="piecewise-linear(3)", default=12.0)
    gap = s.nominal("gap", 10.0, 60.0, 25.0, unit="m")
    speed = s.nominal("approach_speed", 5.0, 30.0, 15.0, unit="m/s")
    friction = s.nominal("friction", 0.2, 0.8, 0.8)
    environment = weather(s, friction)

    road = s.place(pc.RoadSegment(1000.0))
    s.place(environment)
    car = s.place(pc.AutonomousVehicle.along(road.path(1)).starting(10.0).speed(speed.value()))
    leader = pc.Mover("leader", "car", road.path(1)).starting(10.0 + middles(gap.value()))
    s.place(leader.speed(leader_speed))
    roadside(s)

    s.duration(15.0)
    s.monitor(pc.Monitor.no_collision(car))
    s.monitor(pc.Monitor.lane_keeping(car))
    s.monitor(pc.Monitor.progress(car, 10.0))


@pc.scenario
def cut_in(s: pc.Scenario) -> None:
    """a slower vehicle changes into the ego vehicle's lane, right in front of it (UN R157)"""
    speed = s.interval("ego_speed", 20.0, 60.0, unit="km/h", default=50.0)
    relative = s.interval("relative_speed", -50.0, -10.0, unit="km/h", default=-20.0)
    gap = s.interval("gap", 0.0, 60.0, unit="m", default=20.0)
    lateral = s.interval("lateral_speed", 0.5, 3.0, unit="m/s", default=1.0)
    acceleration = s.nominal("acceleration", -3.0, 3.0, 0.0, unit="m/s²", incidental=True)
    side = s.nominal_choice("side", ["left", "right"], "left", incidental=True)
    vehicle = s.nominal_choice("vehicle", list(LENGTHS), "car", incidental=True)
    friction = s.nominal("friction", 0.2, 0.8, 0.8)
    environment = weather(s, friction, later=True)

    s.place(environment)
    road = s.place(pc.RoadSegment(800.0).lanes(6).lane_width(LANE))
    car = s.place(pc.AutonomousVehicle.along(road.path(2)).starting(10.0).speed(speed.value() / 3.6))
    other_speed = (speed.value() + relative.value()) / 3.6
    if other_speed < 0.0:
        s.refuse("the other vehicle would drive backwards")
    elif lateral.value() >= other_speed:
        s.refuse("the vehicle that changes lanes would move to the side faster than it drives")
    other_speed = max(other_speed, 0.0)
    driven = pc.Stream.constant(other_speed)
    if acceleration.value() != 0.0:
        driven = (pc.Stream.time() * acceleration.value() + other_speed).max(0.0).min(80.0 / 3.6)
    lane, towards = (1, -1.0) if side.value() == "left" else (3, 1.0)
    aside = (pc.Stream.time() * lateral.value()).min(LANE) * towards
    kind = vehicle.value()
    start = 10.0 + middles(gap.value(), kind)
    other = s.place(pc.Mover("other", kind, road.path(lane)).starting(start).speed(driven).offset(aside))
    y = other.position().y()
    roadside(s)

    s.duration(20.0)
    s.premise(y <= -LANE if lane == 1 else y >= -2.0 * LANE)
    s.monitor(pc.Monitor.no_collision(car))
    s.monitor(pc.Monitor.lane_keeping(car))


def _loop() -> pc.RoadNetwork:
    roads: pc.TIntersection | pc.Composite = pc.TIntersection().named("tee 1")
    for i in range(1, 5):
        roads = roads.connect(f"tee {i}.one", pc.RoadSegment(25.0).named(f"end {i}"), "one")
        roads = roads.connect(f"tee {i}.two", pc.RoadSegment(60.0).named(f"side {i}"), "one")
        if i < 4:
            roads = roads.connect(f"side {i}.two", pc.TIntersection().named(f"tee {i + 1}"), "three")
    assert isinstance(roads, pc.Composite)
    return roads.close("side 4.two", "tee 1.three").build()


LOOP = _loop()
"""Four straight roads joined by T-intersections. The network is the same in every test, so it is built once."""


@pc.scenario
def t_loop(s: pc.Scenario) -> None:
    """a loop of T-intersections, turning right at each of them"""
    speed = s.interval("speed", 3.0, 12.0, unit="m/s", default=8.0)
    friction = s.interval("friction", 0.2, 0.8, default=0.8)
    environment = weather(s, friction)

    streets = s.place(LOOP)
    s.place(environment)
    for i in range(1, 5):
        for at in (12.0, 30.0, 48.0):
            s.place(pc.Fixture.house(streets.on_sidewalk(f"side {i}", "left", at).moved(forward=-8.0)))
    lap = [lane for i in range(1, 5) for lane in ((f"side {i}", 1), (f"tee {i % 4 + 1}", "three", "two", 1))]
    car = s.place(pc.AutonomousVehicle.along(LOOP.path(10 * lap)).starting(5.0).speed(speed.value()))
    roadside(s)

    s.duration(200.0)
    s.monitor(pc.Monitor.no_collision(car))
    s.monitor(pc.Monitor.on_its_way(car, 2.0))
    s.monitor(pc.Monitor.activity(car, 10.0))


CITY = pc.grid_city(6, 6, 80.0).build()


@pc.scenario
def grid_traffic(s: pc.Scenario) -> None:
    """a route through a city with a hundred cars"""
    seed = s.choice("traffic_seed", [1, 2, 3, 4, 5, 6, 7, 8], default=1)
    speed = s.interval("speed", 5.0, 14.0, unit="m/s", default=9.0)
    cars = s.nominal_choice("cars", [10, 30, 100], 100)
    friction = s.nominal("friction", 0.2, 0.8, 0.8)
    environment = weather(s, friction, later=True)

    s.tick(0.02)
    streets = s.place(CITY)
    s.place(environment)
    way = streets.way(("street 2,0 east", 1, 10.0), ("street 4,5 south", 1, 40.0))
    car = s.place(pc.AutonomousVehicle.along(way).speed(speed.value()))
    start = streets.on_lane("street 2,0 east", 1, 10.0)
    s.place(pc.EnvironmentCars.scattered(streets, cars.value(), seed.value()).away_from(start, 15.0))
    roadside(s)

    s.duration(60.0)
    s.monitor(pc.Monitor.no_collision(car))
    s.monitor(pc.Monitor.right_of_way(car, 1.0))
    s.monitor(pc.Monitor.activity(car, 30.0))


def _circus() -> pc.RoadNetwork:
    circus: pc.Roundabout | pc.Composite = pc.Roundabout().named("circus")
    for point, name in (("one", "east"), ("two", "south"), ("three", "west"), ("four", "north")):
        at = point if isinstance(circus, pc.Roundabout) else f"circus.{point}"
        circus = circus.connect(at, pc.RoadSegment(120.0).named(name), "one")
    assert isinstance(circus, pc.Composite)
    return circus.build()


CIRCUS = _circus()


@pc.scenario
def roundabout_entry(s: pc.Scenario) -> None:
    """the ego vehicle enters a roundabout with another car in it"""
    speed = s.interval("approach_speed", 4.0, 14.0, unit="m/s", default=8.0)
    other_speed = s.interval("other_speed", 3.0, 9.0, unit="m/s", default=6.0)
    lead = s.interval("lead", -4.0, 4.0, unit="s", default=0.5)
    friction = s.nominal("friction", 0.2, 0.8, 0.8)
    environment = weather(s, friction, later=True)

    streets = s.place(CIRCUS)
    s.place(environment)
    way = streets.way(("south", -1, 60.0), ("north", 1, 100.0))
    car = s.place(pc.AutonomousVehicle.along(way).speed(speed.value()))
    # Both cars reach the place where they meet after 60 m of the ego vehicle.
    start = 130.0 - other_speed.value() * (60.0 / speed.value() - lead.value())
    if start < 0.0:
        s.refuse("the other car would have to start before the beginning of its road")
    other = pc.TrafficCar.following(streets, ("west", -1, 110.0), ("north", 1, 100.0), driven=start)
    s.place(pc.EnvironmentCars.on(streets, [other])).drive(0, other_speed)
    roadside(s)

    s.duration(45.0)
    s.monitor(pc.Monitor.no_collision(car))
    s.monitor(pc.Monitor.right_of_way(car, 0.5))
    s.monitor(pc.Monitor.route_completion(car, 60.0))


def _highway() -> pc.RoadNetwork:
    def arm(name: str, length: float) -> pc.RoadSegment:
        return pc.RoadSegment(length).lanes(6).named(name)

    crossing = pc.CrossIntersection().lanes(6).connect("one", arm("east", 150.0), "one")
    crossing = crossing.connect("two", arm("south", 150.0), "one").connect("three", arm("west", 250.0), "one")
    return crossing.connect("four", arm("north", 150.0), "one").build()


HIGHWAY = _highway()


@pc.scenario
def highway_traffic(s: pc.Scenario) -> None:
    """six lanes of traffic, and a truck that crosses them"""
    delay = s.interval("truck_delay", 0.0, 15.0, unit="s", default=8.0)
    truck_speed = s.interval("truck_speed", 3.0, 15.0, unit="m/s", default=8.0)
    speed = s.nominal("ego_speed", 8.0, 25.0, 14.0, unit="m/s")
    traffic_seed = s.nominal_choice("traffic_seed", [1, 2, 3, 4], 1)
    environment = weather(s)

    streets = s.place(HIGHWAY)
    s.place(environment)
    way = streets.way(("west", -1, 240.0), ("east", 1, 140.0))
    car = s.place(pc.AutonomousVehicle.along(way).speed(speed.value()))
    cars = [pc.TrafficCar.following(streets, ("north", -1, 25.0), ("south", 1, 140.0)).body("truck").heedless()]
    seed = traffic_seed.value()
    places = [(road, lane, i) for road, count in (("west", 6), ("east", 3)) for lane in (-3, -2, 2, 3) for i in range(count)]
    for index, (road, lane, i) in enumerate(places):
        even = lane % 2 == 0
        start = (road, lane, 30.0 + 40.0 * i + (0.0 if even else 15.0))
        if (index + seed) % 3 != 0:
            other = pc.TrafficCar(streets, start).changing_lanes()
        elif even:
            other = pc.TrafficCar.truck(streets, start)
        else:
            other = pc.TrafficCar.van(streets, start).changing_lanes()
        cars.append(other.varied(100 * seed + index).moving())
    fleet = s.place(pc.EnvironmentCars.on(streets, cars, seed))
    fleet.drive(0, truck_speed.skip_until(pc.Stream.time() >= delay).hold(0.0))
    roadside(s)

    s.duration(25.0)
    s.monitor(pc.Monitor.no_collision(car))
    s.monitor(pc.Monitor.progress(car, 200.0))
