"""A recorded bus played into the controller's side of the bench: what would today's program have done?"""
