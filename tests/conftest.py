from hypothesis import settings

settings.register_profile("bladegen", deadline=None, max_examples=40, print_blob=True)
settings.load_profile("bladegen")
