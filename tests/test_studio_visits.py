import asyncio

from bladegen.studio.visits import Visits


class Client:
    """What `Visits` asks of a NiceGUI client."""

    def __init__(self, name):
        self.id = name
        self.deleted = False
        self.connected, self.gone = [], []

    def on_connect(self, handler):
        self.connected.append(handler)

    def on_delete(self, handler):
        self.gone.append(handler)

    def connect(self):
        for handler in self.connected:
            handler()

    def delete(self):
        assert not self.deleted
        self.deleted = True
        for handler in self.gone:
            handler()


def visited(count, most=3, patience=60.0, wait=0.0, connect=()):
    clients = [Client(str(i)) for i in range(count)]

    async def loads():
        visits = Visits(most, patience)
        for client in clients:
            visits.begin(client)
            if client.id in connect:
                client.connect()
        await asyncio.sleep(wait)
        return len(visits)

    waiting = asyncio.run(loads())
    return waiting, [client.id for client in clients if client.deleted]


def test_of_many_loads_without_a_connection_the_oldest_go():
    assert visited(80) == (3, [str(i) for i in range(77)])


def test_tabs_that_connect_stay_however_many_they_are():
    assert visited(10, connect={str(i) for i in range(10)}) == (0, [])


def test_a_visit_that_does_not_connect_in_time_goes():
    assert visited(3, patience=0.01, wait=0.1, connect={"1"}) == (0, ["0", "2"])


def test_what_was_deleted_otherwise_is_not_deleted_again():
    async def load():
        client, visits = Client("a"), Visits(3, 0.01)
        visits.begin(client)
        client.delete()
        await asyncio.sleep(0.05)
        return len(visits)

    assert asyncio.run(load()) == 0
